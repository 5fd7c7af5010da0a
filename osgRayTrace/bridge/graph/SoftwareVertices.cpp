// SoftwareVertices.cpp - runs osgAnimation's software transforms on copies. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/SoftwareVertices.h"

#include "osgRayTrace/bridge/common/LibraryName.h"
#include "osgRayTrace/bridge/common/Unshared.h"

#include <osg/Transform>
#include <osgAnimation/BoneMapVisitor>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/MorphTransformHardware>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/RigTransformHardware>
#include <osgAnimation/RigTransformSoftware>
#include <osgAnimation/Skeleton>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

using osgAnimation::MorphGeometry;
using osgAnimation::RigGeometry;

/// Returns whether a geometry is one of osgAnimation's; any other geometry, the common case, costs
/// no cast.
bool isAnimated(const osg::Geometry& geometry)
{
    return isFrom(&geometry, "osgAnimation");
}

bool isHardware(const RigGeometry& rig)
{
    return dynamic_cast<const osgAnimation::RigTransformHardware*>(
        rig.getRigTransformImplementation());
}

bool isHardware(const MorphGeometry& morph)
{
    return dynamic_cast<const osgAnimation::MorphTransformHardware*>(
        morph.getMorphTransformImplementation());
}

bool isEmpty(const osg::Geometry& geometry)
{
    return !geometry.getVertexArray() || geometry.getVertexArray()->getNumElements() == 0;
}

/// Returns positions that osgAnimation can read; null if there are none. Normals must match them in
/// number, as osgAnimation does not check.
const osg::Vec3Array* readablePositions(const osg::Geometry& geometry)
{
    const auto* positions = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
    if (!positions || positions->empty()) return nullptr;
    const osg::Array* normals = geometry.getNormalArray();
    if (!normals) return positions;
    const bool fit = dynamic_cast<const osg::Vec3Array*>(normals) &&
                     normals->getNumElements() == positions->size();
    return fit ? positions : nullptr;
}

/// Returns whether all indices are within the source, because osgAnimation writes to the vertices
/// that they name.
bool isSound(const osgAnimation::VertexInfluenceMap& influences, std::size_t vertices)
{
    for (const auto& [bone, weights] : influences)
        for (const auto& weight : weights)
            if (weight.first >= vertices) return false;
    return true;
}

/// Returns the matrices of the bones, which move the vertices.
std::vector<osg::Matrixf> poseOf(osgAnimation::Skeleton& skeleton)
{
    osgAnimation::BoneMapVisitor bones;
    skeleton.accept(bones);
    std::vector<osg::Matrixf> pose;
    for (const auto& [name, bone] : bones.getBoneMap())
        pose.push_back(bone->getInvBindMatrixInSkeletonSpace() * bone->getMatrixInSkeletonSpace());
    return pose;
}

unsigned int modifiedCount(const osg::Array* array)
{
    return array ? array->getModifiedCount() : 0;
}

/// Copies a rig. The path places the copy, as it has no parents.
class PosedRig : public RigGeometry
{
public:
    explicit PosedRig(RigGeometry& original)
    {
        setSourceGeometry(original.getSourceGeometry());
        setInfluenceMap(original.getInfluenceMap());
        setDataVariance(osg::Object::DYNAMIC);
        setRigTransformImplementation(new osgAnimation::RigTransformSoftware);
        _needToComputeMatrix = false;
        buildVertexInfluenceSet();
    }

    /// Returns whether the source still has the arrays for which the copy was made.
    bool fits(RigGeometry& original) const
    {
        const osg::Geometry& source = *original.getSourceGeometry();
        return getSourceGeometry() == &source && getInfluenceMap() == original.getInfluenceMap() &&
               getVertexArray()->getNumElements() == source.getVertexArray()->getNumElements() &&
               !getNormalArray() == !source.getNormalArray();
    }

    void pose(osgAnimation::Skeleton& skeleton, const osg::Matrix& skeletonFromGeometry)
    {
        std::vector<osg::Matrixf> pose = poseOf(skeleton);
        pose.push_back(skeletonFromGeometry);
        const unsigned int modified = modifiedCount(getSourceGeometry()->getVertexArray()) +
                                      modifiedCount(getSourceGeometry()->getNormalArray());
        if (getSkeleton() == &skeleton && pose == _pose && modified == _modified) return;
        _pose = std::move(pose);
        _modified = modified;
        setSkeleton(&skeleton);
        _matrixFromSkeletonToGeometry = skeletonFromGeometry; // OSG's name is the wrong way round
        _invMatrixFromSkeletonToGeometry = osg::Matrix::inverse(skeletonFromGeometry);
        update();
    }

private:
    std::vector<osg::Matrixf> _pose; // present pose
    unsigned int _modified = 0;      // modified counts of the source for that pose
};

bool canPose(RigGeometry& rig)
{
    const osg::Geometry* source = rig.getSourceGeometry();
    const osg::Vec3Array* positions = source ? readablePositions(*source) : nullptr;
    return positions && rig.getInfluenceMap() && !rig.getInfluenceMap()->empty() &&
           isSound(*rig.getInfluenceMap(), positions->size());
}

bool poseRig(PosedRig& rig, const osg::NodePath& path)
{
    osg::NodePath below;
    for (auto node = path.rbegin(); node != path.rend(); ++node)
    {
        if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(*node))
        {
            rig.pose(*skeleton, osg::computeLocalToWorld(below));
            return true;
        }
        below.insert(below.begin(), *node);
    }
    return false;
}

/// Returns a copy with arrays of its own that shares all else. OSG's constructor would share the
/// array that it writes to.
osg::ref_ptr<MorphGeometry> copyOf(MorphGeometry& original)
{
    osg::ref_ptr<MorphGeometry> copy = new MorphGeometry(original, osg::CopyOp::SHALLOW_COPY);
    copy->setUpdateCallback(nullptr);
    copy->setStateSet(nullptr);
    copy->setDataVariance(osg::Object::DYNAMIC);
    copy->setMorphTransformImplementation(new osgAnimation::MorphTransformSoftware);
    const osg::Vec3Array* source =
        original.getVertexSource() ? original.getVertexSource() : readablePositions(original);
    copy->setVertexArray(new osg::Vec3Array(*source));
    copy->setVertexSource(new osg::Vec3Array(*source));
    const auto* normals = original.getNormalSource()
                              ? original.getNormalSource()
                              : dynamic_cast<const osg::Vec3Array*>(original.getNormalArray());
    copy->setNormalSource(normals ? new osg::Vec3Array(*normals) : new osg::Vec3Array);
    copy->setNormalArray(normals ? new osg::Vec3Array(*normals) : nullptr,
                         osg::Array::BIND_PER_VERTEX);
    copy->setMorphNormals(normals && original.getMorphNormals());
    return copy;
}

bool canPose(MorphGeometry& morph)
{
    const osg::Vec3Array* positions = readablePositions(morph);
    if (!positions) return false;
    const std::size_t size = positions->size();
    if (morph.getVertexSource() && morph.getVertexSource()->size() != size) return false;
    if (morph.getNormalSource() && morph.getNormalSource()->size() != size) return false;
    for (const MorphGeometry::MorphTarget& target : morph.getMorphTargetList())
    {
        const osg::Vec3Array* moved =
            target.getGeometry() ? readablePositions(*target.getGeometry()) : nullptr;
        if (!moved || moved->size() < size) return false;
    }
    return true;
}

bool fits(const MorphGeometry& copy, const MorphGeometry& original)
{
    return copy.getMorphTargetList().size() == original.getMorphTargetList().size() &&
           copy.getVertexArray()->getNumElements() == original.getVertexArray()->getNumElements();
}

void poseMorph(MorphGeometry& copy, MorphGeometry& original)
{
    bool changed = copy.getVertexArray()->getModifiedCount() == 0;
    for (unsigned int i = 0; i < copy.getMorphTargetList().size(); ++i)
    {
        const float weight = original.getMorphTarget(i).getWeight();
        changed = changed || copy.getMorphTarget(i).getWeight() != weight;
        copy.getMorphTarget(i).setWeight(weight);
    }
    if (!changed) return;
    copy.dirty();
    copy.transformSoftwareMethod();
}

} // namespace

bool SoftwareVertices::isPosedByProgram(const osg::Geometry& geometry)
{
    if (!isAnimated(geometry)) return false;
    const auto* rig = dynamic_cast<const RigGeometry*>(&geometry);
    const auto* morph = dynamic_cast<const MorphGeometry*>(&geometry);
    return (rig && isHardware(*rig)) || (morph && isHardware(*morph));
}

std::vector<float> SoftwareVertices::weightsOf(const osg::Geometry& geometry)
{
    std::vector<float> weights;
    const auto* morph =
        isAnimated(geometry) ? dynamic_cast<const MorphGeometry*>(&geometry) : nullptr;
    if (!morph) return weights;
    for (const MorphGeometry::MorphTarget& target : morph->getMorphTargetList())
        weights.push_back(target.getWeight());
    return weights;
}

const osg::Geometry& SoftwareVertices::posed(osg::Geometry& geometry, const osg::NodePath& path)
{
    if (!isAnimated(geometry)) return geometry;
    auto* rig = dynamic_cast<RigGeometry*>(&geometry);
    auto* morph = dynamic_cast<MorphGeometry*>(&geometry);
    const bool poseRigHere = rig && (isHardware(*rig) || isEmpty(*rig)) && canPose(*rig);
    const bool poseMorphHere = morph && isHardware(*morph) && canPose(*morph);
    if (!poseRigHere && !poseMorphHere) return geometry;

    Copy& copy = _copies[&geometry];
    copy.used = _round;
    if (copy.posed && (rig ? !static_cast<PosedRig&>(*copy.posed).fits(*rig)
                           : !fits(static_cast<MorphGeometry&>(*copy.posed), *morph)))
        copy.posed = nullptr;
    if (!copy.posed)
    {
        copy.original = &geometry;
        if (rig)
            copy.posed = new PosedRig(*rig);
        else
            copy.posed = copyOf(*morph);
    }
    if (!rig)
        poseMorph(static_cast<MorphGeometry&>(*copy.posed), *morph);
    else if (!poseRig(static_cast<PosedRig&>(*copy.posed), path))
        return geometry;
    return *copy.posed;
}

void SoftwareVertices::end()
{
    eraseUnused(_copies, _round);
}

void SoftwareVertices::dropUnshared()
{
    eraseUnshared(_copies, [](const Copy& copy) { return copy.original.get(); });
}

} // namespace osgRayTrace::engine
