"""A tour of `import svdag` in pictures; cells as of a notebook. Run it anywhere: it writes tour.svdag and four PNGs."""
# %% A scene: a torus that stands on a floor, as NumPy arrays.
import matplotlib
import numpy as np

import svdag

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402


def torus(n=96):
    u, v = np.meshgrid(*[np.linspace(0, 2 * np.pi, n, endpoint=False)] * 2, indexing="ij")
    points = np.stack([(2 + 0.7 * np.cos(v)) * np.cos(u), (2 + 0.7 * np.cos(v)) * np.sin(u), 0.7 * np.sin(v)], -1)
    a = np.arange(n * n).reshape(n, n)
    b, c = np.roll(a, -1, 0), np.roll(a, -1, 1)
    d = np.roll(b, -1, 1)
    return points.reshape(-1, 3), np.concatenate([np.stack([a, b, d], -1), np.stack([a, d, c], -1)]).reshape(-1, 3)


points, faces = torus()
floor = np.array([[-3, -3, -0.8], [3, -3, -0.8], [3, 3, -0.8], [-3, 3, -0.8]], float), np.array([[0, 1, 2], [0, 2, 3]])
report = svdag.build({"torus": (points[:, [0, 2, 1]], faces[:, ::-1]), "floor": (floor[0][:, [0, 2, 1]], floor[1])}, path="tour.svdag",
                     resolution="1K", rule="solid", open="surface")
print(f"{report['voxels']:,} voxels in {report['file_bytes'] / 2 ** 20:.1f} MiB")
scene = svdag.open("tour.svdag")

# %% A section through the solid: one layer of voxels.
height = int((0 - scene.origin[1]) / scene.voxel_size)
section = scene.window((0, height, 0), (scene.resolution, height + 1, scene.resolution))[:, 0]
plot.figure()
plot.imshow(section.T, origin="lower", cmap="Greys")
plot.title("The torus at half its height")
plot.savefig("section.png")

# %% Levels of detail: a cube is set if a voxel of it is.
figure, axes = plot.subplots(1, 4, figsize=(12, 3))
for axis, level in zip(axes, (4, 5, 6, 8)):
    side = 2 ** level
    axis.imshow(scene.window((0, 0, 0), (side,) * 3, level=level).any(1).T, origin="lower", cmap="Greys")
    axis.set_title(f"{side}$^3$: {scene.count(level=level):,}")
figure.savefig("levels.png")

# %% Rays: depth and layers, seen from above.
z, x = np.mgrid[-3:3:600j, -3:3:600j]
eyes = np.stack([x, np.full(x.shape, 5), z], -1).reshape(-1, 3)
hits = scene.trace(eyes, [0, -1, 0])
figure, axes = plot.subplots(1, 2, figsize=(9, 4))
axes[0].imshow(np.where(np.isfinite(hits.t), hits.t, np.nan).reshape(x.shape), cmap="viridis")
axes[0].set_title("distance")
axes[1].imshow(hits.layer.reshape(x.shape), cmap="tab10", vmin=-1, vmax=8)
axes[1].set_title(", ".join(f"{i}: {layer.name}" for i, layer in enumerate(scene.layers)))
figure.savefig("rays.png")

# %% Points: the volume of the torus by chance, beside 2 pi^2 R r^2.
random = np.random.default_rng(1)
low, high = np.array([-3, -0.75, -3]), np.array([3, 0.75, 3])
inside = scene.occupied(random.uniform(low, high, (1000000, 3)), layer="torus")
print(f"volume {inside.mean() * (high - low).prod():.2f}, exactly {2 * np.pi ** 2 * 2 * 0.7 ** 2:.2f}")
plot.figure()
distances = np.linspace(0, 1, 50)
plot.plot(distances, [len(scene.sphere((scene.resolution // 2, height, scene.resolution // 2), r * 300)) for r in distances])
plot.title("Voxels within a ball that grows")
plot.savefig("ball.png")
scene.close()
