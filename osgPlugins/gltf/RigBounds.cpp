// RigBounds.cpp - poses skeletons to see how far their meshes reach. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/RigBounds.h"

#include <osg/NodeVisitor>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/UpdateBone>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace osgRayTrace::gltf
{

namespace
{

constexpr int kPoses = 16; ///< of an animation
constexpr std::size_t kMostPosedBones = std::size_t(1) << 20;

/// Finds bones and rigs; moves the bones as an update traversal does, and nothing else.
class Skeletons : public osg::NodeVisitor
{
public:
    Skeletons() : osg::NodeVisitor(UPDATE_VISITOR, TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override
    {
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node)) bones[bone->getName()] = bone;
        osg::Callback* callback = node.getUpdateCallback();
        if (dynamic_cast<osgAnimation::UpdateBone*>(callback))
            callback->run(&node, this);
        else
            traverse(node);
    }

    void apply(osg::Geometry& geometry) override
    {
        auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(&geometry);
        if (rig) rigs.push_back(rig);
    }
    using osg::NodeVisitor::apply;

    std::map<std::string, osgAnimation::Bone*> bones;
    std::vector<osgAnimation::RigGeometry*> rigs;
};

/// The vertices that follow a bone, in the coordinates of the bone.
struct BoneBox
{
    osgAnimation::Bone* bone;
    osg::BoundingBox box;
};

struct RigBoxes
{
    osgAnimation::RigGeometry* rig;
    std::vector<BoneBox> boxes;
    osg::BoundingBox bound;

    void addPose()
    {
        for (const BoneBox& box : boxes)
            for (unsigned int corner = 0; corner < 8; ++corner)
                bound.expandBy(box.box.corner(corner) * box.bone->getMatrixInSkeletonSpace());
    }
};

RigBoxes boxesOf(osgAnimation::RigGeometry& rig,
                 const std::map<std::string, osgAnimation::Bone*>& bones)
{
    RigBoxes result{&rig, {}, {}};
    const auto* positions =
        dynamic_cast<const osg::Vec3Array*>(rig.getSourceGeometry()->getVertexArray());
    if (!positions || !rig.getInfluenceMap()) return result;
    for (const auto& [name, influence] : *rig.getInfluenceMap())
    {
        const auto bone = bones.find(name);
        if (bone == bones.end()) continue;
        BoneBox box{bone->second, {}};
        const osg::Matrix& inverseBind = bone->second->getInvBindMatrixInSkeletonSpace();
        for (const auto& [vertex, weight] : influence)
            box.box.expandBy((*positions)[vertex] * inverseBind);
        if (box.box.valid()) result.boxes.push_back(box);
    }
    return result;
}

/// Moves the skeleton to a time of an animation.
void pose(osg::Group& scene, osgAnimation::Animation& animation, double time)
{
    const float weight = animation.getWeight();
    animation.setWeight(1.0f);
    animation.resetTargets();
    animation.update(time);
    animation.resetTargets();
    animation.setWeight(weight);
    Skeletons move;
    scene.accept(move);
}

} // namespace

void setRigBounds(osg::Group& scene, osgAnimation::BasicAnimationManager* manager)
{
    Skeletons found;
    scene.accept(found);
    std::vector<RigBoxes> rigs;
    for (osgAnimation::RigGeometry* rig : found.rigs)
        rigs.push_back(boxesOf(*rig, found.bones));
    const auto addPose = [&rigs]
    {
        for (RigBoxes& boxes : rigs)
            boxes.addPose();
    };
    addPose();
    if (manager)
    {
        manager->link(&scene);
        const osgAnimation::AnimationList& list = manager->getAnimationList();
        const std::size_t most =
            kMostPosedBones / (kPoses * std::max<std::size_t>(found.bones.size(), 1));
        for (std::size_t i = 0; i < std::min(list.size(), most); ++i)
            for (int k = 0; k < kPoses; ++k)
            {
                pose(scene, *list[i], list[i]->getDuration() * k / (kPoses - 1));
                addPose();
            }
        pose(scene, *list.front(), 0.0);
    }
    for (RigBoxes& boxes : rigs)
        if (boxes.bound.valid()) boxes.rig->setInitialBound(boxes.bound);
}

} // namespace osgRayTrace::gltf
