// The page of a server or a folder: scene and tiles are files beside it.
import {start} from './view.js';

// The bytes of a file. An error with `retry` is one of the network.
async function get(path) {
  let response, bytes;
  try {
    response = await fetch(path);
    bytes = await response.arrayBuffer();
  } catch (error) {
    throw Object.assign(error, {retry: true});
  }
  if (!response.ok) throw new Error(`${path}: ${response.status} ${response.statusText}`);
  return bytes;
}

async function main() {
  const parent = document.getElementById('svdag');
  try {
    const scene = JSON.parse(new TextDecoder().decode(await get('scene.json')));
    document.title = scene.name;
    const load = async (path) => unpack(await get(path));
    const viewer = start(parent, {scene, tile: (id) => load(`tiles/${id}`), colours: (id, level) => load(`colours/${id}/${level}`)});
    if (!scene.served) return;
    const alive = new EventSource('alive');  // tells the server that the page is open
    alive.onerror = () => viewer?.report('The server does not answer.');
    alive.onopen = () => viewer?.report('');
  } catch (error) {
    parent.textContent = error.message;
  }
}

async function unpack(packed) {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  const bytes = await new Response(stream).arrayBuffer();
  return new Uint32Array(bytes, 0, bytes.byteLength >> 2);
}

main();
