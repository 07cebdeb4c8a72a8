"""Import a BVH file in Blender without a window and save where it puts the joints (see BLENDER.md).

blender --background --factory-startup --python docs/blender_import.py -- walk.bvh joints.json
"""

import builtins
import json
import sys

import bpy
from io_anim_bvh import import_bvh

source, target = sys.argv[sys.argv.index("--") + 1 :]
# Blender 3.4 opens the file with mode "rU", which Python 3.11 no longer supports. Newer versions
# of Blender do not need this line.
import_bvh.open = lambda path, mode="r", **more: builtins.open(path, mode.replace("U", ""), **more)

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
bpy.ops.import_anim.bvh(
    filepath=source, global_scale=0.01, update_scene_fps=True, update_scene_duration=True
)
figure = bpy.context.object
first, last = map(int, figure.animation_data.action.frame_range)
frames = {}
for frame in (first, (first + last) // 2, last):
    scene.frame_set(frame)
    frames[frame - first] = {
        bone.name: list(figure.matrix_world @ bone.head) for bone in figure.pose.bones
    }
with open(target, "w") as file:
    json.dump({"fps": scene.render.fps / scene.render.fps_base, "frames": frames}, file)
print(f"{len(figure.pose.bones)} bones, frames {first} to {last}")
