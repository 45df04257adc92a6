// The page of a server or a folder: scene and tiles are files beside it.
import {start} from './view.js';

async function get(path) {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path}: ${response.status} ${response.statusText}`);
  return response;
}

async function main() {
  const parent = document.getElementById('viewer');
  try {
    const scene = await (await get('scene.json')).json();
    document.title = scene.name;
    start(parent, {scene, tile: async (id) => unpack((await get(`tiles/${id}`)).body)});
    if (scene.served) new EventSource('alive');  // tells the server that the page is open
  } catch (error) {
    parent.textContent = error.message;
  }
}

async function unpack(stream) {
  const bytes = await new Response(stream.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
  return new Uint32Array(bytes, 0, bytes.byteLength >> 2);
}

main();
