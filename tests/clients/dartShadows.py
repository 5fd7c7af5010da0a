# dartShadows.py - DART's viewer (Debian's python3-dartpy) with a box over a floor, and its shadows.
# SPDX-License-Identifier: MIT
import sys

try:
    import dartpy as dart
except ImportError:
    sys.exit(77)


def box(name, size, place, mobile):
    skeleton = dart.dynamics.Skeleton(name)
    if mobile:
        joint, body = skeleton.createFreeJointAndBodyNodePair()
    else:
        joint, body = skeleton.createWeldJointAndBodyNodePair()
    node = body.createShapeNode(dart.dynamics.BoxShape(size))
    node.createVisualAspect().setColor([0.3, 0.5, 0.8])
    pose = dart.math.Isometry3()
    pose.set_translation(place)
    if mobile:
        joint.setTransform(pose)
    else:
        joint.setTransformFromParentBodyNode(pose)
    return skeleton


world = dart.simulation.World()
world.addSkeleton(box("floor", [4, 4, 0.1], [0, 0, -0.05], False))
world.addSkeleton(box("box", [0.5, 0.5, 0.5], [0, 0, 0.6], True))
node = dart.gui.osg.RealTimeWorldNode(world)
viewer = dart.gui.osg.Viewer()
viewer.addWorldNode(node)
node.setShadowTechnique(dart.gui.osg.WorldNode.createDefaultShadowTechnique(viewer))
viewer.setUpViewInWindow(0, 0, 320, 240)
viewer.setCameraHomePosition([3, 2, 2], [0, 0, 0], [0, 0, 1])
viewer.run()
