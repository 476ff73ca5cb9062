"""A sunflower of spheres through a wide lens, sharp at one distance: depth_of_field.png."""

import numpy as np

import pinhole as ph

number = np.arange(1, 900)
angle = number * np.pi * (3 - 5**0.5)  # the golden angle
away = 0.5 * np.sqrt(number)
radius = 0.3 + 0.012 * away
height = radius + 2.2 * np.exp(-((away / 4.5) ** 2))
points = np.stack([away * np.cos(angle), height, away * np.sin(angle)], axis=1)
spheres = ph.Spheres(points, radius, color=away, cmap="plasma_r")
camera = ph.Camera.look_at(
    (0, 7.5, 17), (0, 1.2, 0.5), fov=27, kind="thin-lens", aperture_radius=0.4, focus_on=(0, 1.5, 3.2)
)
spheres.render(
    (840, 520), style="path", samples=24, camera=camera, ground={"height": 0, "color": "#3a2a4a"}, background="#241a33"
).save("depth_of_field.png")
