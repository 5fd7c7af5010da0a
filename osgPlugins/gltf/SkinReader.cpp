// SkinReader.cpp - binds vertices to bones. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/SkinReader.h"

#include <osgAnimation/UpdateBone>

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::size_t kMostBindings = 64; ///< of one joint, by different skins

} // namespace

SkinReader::SkinReader(Document& document, const NodeTree& tree)
    : _document(&document), _isBone(tree.count(), false)
{
    for (std::size_t i = 0; i < document.count("skins"); ++i)
    {
        const JsonPlace joints = document.element("skins", i).at("joints");
        for (std::size_t k = 0; k < joints.size(); ++k)
        {
            std::size_t node = joints[k].index(tree.count());
            for (; node != NodeTree::kNone && !_isBone[node]; node = tree.parent(node))
                _isBone[node] = true;
            _hasBones = true;
        }
    }
}

std::string SkinReader::newName(std::string wanted, std::size_t number)
{
    while (wanted.empty() || !_names.insert(wanted).second)
        wanted += "#" + std::to_string(number);
    return wanted;
}

/// Returns the bone, among the joint and those that stay with it, whose vertices are bound by a
/// matrix. osgAnimation keeps that matrix in the bone.
osgAnimation::Bone* SkinReader::boundBone(osgAnimation::Bone& joint, const osg::Matrix& inverseBind,
                                          const JsonPlace& place)
{
    std::vector<osgAnimation::Bone*>& bound = _bound[&joint];
    for (osgAnimation::Bone* bone : bound)
        if (bone->getInvBindMatrixInSkeletonSpace() == inverseBind) return bone;
    if (bound.size() == kMostBindings)
        place.refuse("node '" + joint.getName() + "' is bound in more than 64 places");
    osg::ref_ptr<osgAnimation::Bone> bone = &joint;
    if (!bound.empty())
    {
        bone = new osgAnimation::Bone(newName(joint.getName(), bound.size()));
        bone->setUpdateCallback(new osgAnimation::UpdateBone(bone->getName()));
        bone->setMatrixInSkeletonSpace(joint.getMatrixInSkeletonSpace());
        joint.insertChild(0, bone); // osgAnimation wants bones before other children
    }
    bone->setInvBindMatrixInSkeletonSpace(inverseBind);
    bound.push_back(bone.get());
    return bone.get();
}

const Skin& SkinReader::read(std::size_t number,
                             const std::map<std::size_t, osgAnimation::Bone*>& bones,
                             AccessorReader& accessors)
{
    const auto held = _skins.find(number);
    if (held != _skins.end()) return held->second;

    const JsonPlace place = _document->element("skins", number);
    const JsonPlace joints = place.at("joints");
    std::vector<float> matrices;
    if (const auto index = place.find("inverseBindMatrices"))
    {
        const Accessor accessor = accessors.open(*index, 16);
        if (accessor.count < joints.size())
            index->refuse("has " + std::to_string(accessor.count) + " matrices for " +
                          std::to_string(joints.size()) + " joints");
        _document->take(accessor.count * 64, accessor.place);
        matrices.resize(accessor.count * 16);
        accessors.copyFloats(accessor, matrices.data());
    }
    Skin skin;
    for (std::size_t i = 0; i < joints.size(); ++i)
    {
        const auto bone = bones.find(joints[i].index(_isBone.size()));
        if (bone == bones.end()) joints[i].refuse("is a node that is not in the scene");
        const osg::Matrix inverseBind =
            matrices.empty() ? osg::Matrix() : osg::Matrix(matrices.data() + 16 * i);
        skin.bones.emplace_back(boundBone(*bone->second, inverseBind, joints[i]));
    }
    return _skins.emplace(number, std::move(skin)).first->second;
}

namespace
{

/// Adds the influence of one joint on one vertex.
void addInfluence(osgAnimation::VertexInfluenceMap& map, const osgAnimation::Bone& bone,
                  unsigned int vertex, float weight)
{
    osgAnimation::VertexInfluence& influence = map[bone.getName()];
    influence.setName(bone.getName());
    influence.emplace_back(vertex, weight);
}

osg::ref_ptr<osgAnimation::VertexInfluenceMap>
influencesOf(const Vertices& vertices, const Skin& skin, const JsonPlace& primitive)
{
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (unsigned int vertex = 0; vertex < vertices.count(); ++vertex)
    {
        bool moved = false;
        for (const JointSet& set : vertices.jointSets)
            for (int i = 0; i < 4; ++i)
            {
                const std::size_t joint = set.joints[vertex][i];
                const float weight = (*set.weights)[vertex][i];
                if (!(weight > 0.0f)) continue;
                if (joint >= skin.bones.size())
                    primitive.refuse("vertex " + std::to_string(vertex) + " has joint " +
                                     std::to_string(joint) + ", and the skin has " +
                                     std::to_string(skin.bones.size()));
                addInfluence(*map, *skin.bones[joint], vertex, weight);
                moved = true;
            }
        // A vertex without weights would fall to the origin.
        if (!moved) addInfluence(*map, *skin.bones.front(), vertex, 1.0f);
    }
    return map;
}

} // namespace

osg::ref_ptr<osgAnimation::RigGeometry> riggedGeometry(osg::Geometry& source,
                                                       const Vertices& vertices, const Skin& skin,
                                                       const JsonPlace& primitive)
{
    const osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setName(source.getName());
    rig->setSourceGeometry(&source);
    rig->setInfluenceMap(influencesOf(vertices, skin, primitive).get());
    rig->buildVertexInfluenceSet();
    return rig;
}

} // namespace osgRayTrace::gltf
