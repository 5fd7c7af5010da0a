// MovedTangents.cpp - adds the tangents of morph targets. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/MovedTangents.h"

#include "osgRayTrace/bridge/common/LibraryName.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"

#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>

namespace osgRayTrace::engine
{

namespace
{

using osgAnimation::MorphGeometry;

/// Returns the floats of an array of three or four a vertex; null for other arrays and sizes.
const float* floatsOf(const osg::Array* array, std::size_t count)
{
    const bool fits = array && array->getDataType() == GL_FLOAT && array->getDataSize() >= 3 &&
                      array->getDataSize() <= 4 && array->getNumElements() == count;
    return fits ? static_cast<const float*>(array->getDataPointer()) : nullptr;
}

/// Adds the directions of a target, times its weight.
void addTarget(const osg::Array& target, float weight, osg::Vec4Array& sum)
{
    const float* floats = floatsOf(&target, sum.size());
    const unsigned int size = target.getDataSize();
    for (osg::Vec4& tangent : sum)
    {
        for (unsigned int c = 0; c < 3; ++c)
            tangent[c] += weight * floats[c];
        floats += size;
    }
}

/// Returns base + the sum of weight * target, or with the method NORMALIZED (1 - the sum of
/// weights) * base + that sum. Null if no target has tangents. osgAnimation leaves out weights that
/// are not above 0, and so must tangents.
osg::ref_ptr<const osg::Array> morphed(const MorphGeometry& morph, const osg::Array& tangents)
{
    const std::size_t count = tangents.getNumElements();
    const float* base = floatsOf(&tangents, count);
    if (!base || tangents.getDataSize() != 4) return nullptr;
    bool any = false;
    float sumOfWeights = 0.0f;
    for (const MorphGeometry::MorphTarget& target : morph.getMorphTargetList())
    {
        any |= target.getGeometry() && floatsOf(tangentArray(*target.getGeometry()), count);
        sumOfWeights += target.getWeight();
    }
    if (!any) return nullptr;
    const osg::ref_ptr<osg::Vec4Array> sum =
        new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(count),
                           reinterpret_cast<const osg::Vec4*>(base));
    if (morph.getMethod() == MorphGeometry::NORMALIZED)
        for (osg::Vec4& tangent : *sum)
            for (unsigned int c = 0; c < 3; ++c)
                tangent[c] *= 1.0f - sumOfWeights;
    for (const MorphGeometry::MorphTarget& target : morph.getMorphTargetList())
    {
        const osg::Array* own =
            target.getGeometry() ? tangentArray(*target.getGeometry()) : nullptr;
        if (target.getWeight() > 0.0f && floatsOf(own, count))
            addTarget(*own, target.getWeight(), *sum);
    }
    return sum;
}

} // namespace

osg::ref_ptr<const osg::Array> tangentsNow(const osg::Geometry& geometry, bool deforms)
{
    const osg::Array* tangents = tangentArray(geometry);
    if (!tangents || !isFrom(&geometry, "osgAnimation")) return deforms ? nullptr : tangents;
    if (const auto* morph = dynamic_cast<const MorphGeometry*>(&geometry))
        return morphed(*morph, *tangents);
    return dynamic_cast<const osgAnimation::RigGeometry*>(&geometry) || deforms ? nullptr
                                                                                : tangents;
}

} // namespace osgRayTrace::engine
