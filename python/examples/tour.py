# %% [markdown]
# # A tour of Relief in Python
#
# From a depth picture to a ball on the floor, hands and a recording. The room is synthetic, so you need no camera.
# A recording's path or a camera's name from `relief list sources` works as well.

# %%
import matplotlib

matplotlib.use("Agg")  # no display needed
import matplotlib.pyplot as plt
import numpy as np
import relief

# %% [markdown]
# ## A frame
#
# Iterate a source to get its frames. A frame owns its arrays, so you may keep it.

# %%
with relief.open("synthetic:room") as source:
    frame = next(source)
    print(source.rig.depth, "with", source.frame_count, "frames")

print(frame.depth.shape, frame.depth.dtype, "of", frame.units_per_metre, "units a metre")
metres = frame.depth / frame.units_per_metre
print(f"{np.mean(frame.depth > 0):.0%} of the pixels have depth, median {np.median(metres):.1f} m")

# %% [markdown]
# ## A surface
#
# A pipeline makes a surface of every frame: points, unit normals, what moves and how fast. Its arrays show the pipeline's
# memory and cost nothing. The next step writes over them: copy what you keep.

# %%
with relief.Pipeline("synthetic:room", render=False) as pipeline:
    for _, step in zip(range(60), pipeline):
        pass
    surface = step.surface
    normals = surface.normals.copy()
    moves = surface.foreground != 0
    speed = np.linalg.norm(surface.velocity, axis=2)
    print(f"somebody is {surface.points[moves, 2].min():.1f} m away, mostly at {np.median(speed[moves]):.1f} m/s")
    up, confidence = surface.find_up()
    print(f"up is {np.round(up, 1) + 0.0}, {confidence:.0%} sure")

# %% [markdown]
# ## A body
#
# Bodies collide with whatever the camera sees. Your `on_contact` function is called when a contact begins or ends.

# %%
heights, times = [], []
with relief.Pipeline("synthetic:room") as pipeline:
    ball = pipeline.world.add("sphere", radius=0.1, position=(0, 0, 3), restitution=0.6)
    pipeline.on_contact(lambda kind, body, other: kind == "begin" and print(body, "meets the", other))
    for _, step in zip(range(60), pipeline):
        times.append(step.time)
        heights.append(-ball.position[1])
    picture = step.picture.copy()

# %% [markdown]
# ## Pictures
#
# Every array is a NumPy array, so matplotlib shows it.

# %%
figure, axes = plt.subplots(2, 2, figsize=(9, 6.4), layout="constrained")
for axis, image, title in (
    (axes[0, 0], np.where(metres > 0, metres, np.nan), "depth, m"),
    (axes[0, 1], (1 - normals) / 2, "normals"),
    (axes[1, 0], picture, "a ball in the room"),
):
    axis.imshow(image, cmap="turbo")
    axis.set_title(title)
    axis.axis("off")
axes[1, 1].plot(times, heights)
axes[1, 1].set(title="height of the ball", xlabel="s", ylabel="m above the camera")
figure.savefig("python_tour.png", dpi=70)

# %% [markdown]
# ![depth, normals, a ball in the room, and its height over time](pictures/python_tour.png)
#
# ## Hands
#
# Ask for hands, and act on those that are sure. Here two hands come in from one side, and one of them waves.

# %%
with relief.Pipeline("synthetic:hands?gesture=wave", hands=True, render=False) as pipeline:
    for _, step in zip(range(120), pipeline):
        for event in step.hand_events:
            print(f"{step.time:.1f} s: {event.kind} by hand {event.hand}")
    for hand in step.hands:
        if hand.is_sure:
            print(f"{hand.side} hand: {hand.gesture}, {hand.palm[2]:.1f} m away, {len(hand.tips)} tips")

# %% [markdown]
# ## A recording
#
# You can record a pipeline while it runs, in the formats of `relief record`. Open the recording like any source.

# %%
with relief.Pipeline("synthetic:room", render=False) as pipeline:
    with relief.Recording("clip.mcap", pipeline) as recording:
        for _, step in zip(range(10), pipeline):
            recording.add(step)

with relief.open("clip.mcap") as source:
    print(sum(1 for frame in source), "frames read again")

# %% [markdown]
# ## Your own camera
#
# If your camera gives NumPy arrays, push them. Depth is `uint16` with its unit, or `float32` in metres.

# %%
camera = relief.Camera(160, 120, fx=120, fy=120, cx=79.5, cy=59.5)
with relief.Pipeline(camera, gravity=(0, 0, 9.81)) as pipeline:
    table = np.eye(4)
    table[:3, 3] = 0, 0, 1.5  # a table that the camera cannot see, but somebody measured
    pipeline.set_known("table", size=(1, 1, 0.1), pose=table)
    box = pipeline.world.add("box", size=(0.2, 0.2, 0.2), position=(0, 0, 1))
    for i in range(60):
        depth = np.full((120, 160), 2000, np.uint16)  # your camera's
        pipeline.push(depth, time=i / 30)
    print(f"the box lies {box.position[2]:.2f} m before the camera, on the table")
