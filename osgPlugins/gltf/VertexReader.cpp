// VertexReader.cpp - reads attributes, morph targets and indices. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/VertexReader.h"

#include "osgPlugins/gltf/Srgb.h"

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::size_t kMostTexcoords = 8, kMostJointSets = 4, kMostTargets = 1024;
constexpr std::uint64_t kTriangleFan = 6; ///< the last mode; all are numbered as in OpenGL
constexpr std::uint64_t kTriangles = 4;

/// Returns the display values of all linear bytes.
std::array<unsigned char, 256> displayBytes()
{
    std::array<unsigned char, 256> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<unsigned char>(
            displayValue(static_cast<float>(i) / 255.0f) * 255.0f + 0.5f);
    return bytes;
}

/// Returns how many of so many vertices make whole primitives: OSG's functors read past the end of
/// what does not.
std::size_t wholeCount(GLenum mode, std::size_t count)
{
    switch (mode)
    {
    case GL_POINTS:
        return count;
    case GL_LINES:
        return count - count % 2;
    case GL_LINE_LOOP:
    case GL_LINE_STRIP:
        return count < 2 ? 0 : count;
    case GL_TRIANGLES:
        return count - count % 3;
    default:
        return count < 3 ? 0 : count;
    }
}

/// Returns at least one index.
template <typename Elements>
osg::ref_ptr<osg::PrimitiveSet> drawElements(AccessorReader& reader, const Accessor& accessor,
                                             GLenum mode, std::size_t vertices)
{
    const osg::ref_ptr<Elements> elements =
        new Elements(mode, static_cast<unsigned int>(accessor.count));
    reader.copy(accessor, &elements->front());
    elements->resize(wholeCount(mode, accessor.count));
    const auto largest = *std::max_element(elements->begin(), elements->end());
    if (largest >= vertices)
        accessor.place.refuse("has the index " + std::to_string(largest) + ", and there are " +
                              std::to_string(vertices) + " vertices");
    return elements;
}

/// Refuses an attribute that is not one for each vertex.
void checkCount(const osg::Array* array, const std::string& name, std::size_t vertices,
                const JsonPlace& primitive)
{
    if (array && array->getNumElements() != vertices)
        primitive.refuse("has " + std::to_string(array->getNumElements()) + " elements of " + name +
                         " for " + std::to_string(vertices) + " vertices");
}

} // namespace

/// Returns the elements of an accessor as an array, which is read straight from the file if it
/// holds floats.
template <typename ArrayType>
osg::ref_ptr<ArrayType> VertexReader::floats(const JsonPlace& index, Role role)
{
    using Element = typename ArrayType::ElementDataType;
    const Accessor accessor = _accessors.open(index, Element::num_components);
    osg::ref_ptr<osg::Array>& held = _arrays[{index.index(SIZE_MAX), role}];
    if (held) return static_cast<ArrayType*>(held.get());
    _accessors.document().take(accessor.count * sizeof(Element), accessor.place);
    const osg::ref_ptr<ArrayType> array =
        new ArrayType(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(accessor.count));
    if (accessor.count > 0) _accessors.copyFloats(accessor, array->front().ptr());
    if (role == Role::Texcoord)
        for (Element& uv : *array)
            uv.y() = 1.0f - uv.y();
    held = array;
    return array;
}

osg::ref_ptr<osg::Array> VertexReader::colors(const JsonPlace& index)
{
    const Accessor accessor = _accessors.open(index);
    osg::ref_ptr<osg::Array>& held = _arrays[{index.index(SIZE_MAX), Role::Color}];
    if (held) return held;
    if (accessor.components != 3 && accessor.components != 4)
        accessor.place.refuse("has colours of " + std::to_string(accessor.components) +
                              " components");
    const auto count = static_cast<unsigned int>(accessor.count);
    if (accessor.type == ComponentType::UnsignedByte && accessor.components == 4)
    {
        _accessors.document().take(accessor.count * 4, accessor.place);
        const osg::ref_ptr<osg::Vec4ubArray> array =
            new osg::Vec4ubArray(osg::Array::BIND_PER_VERTEX, count);
        array->setNormalize(true);
        if (count > 0) _accessors.copy(accessor, array->front().ptr());
        const std::array<unsigned char, 256> display = displayBytes();
        for (osg::Vec4ub& color : *array)
            color.set(display[color.r()], display[color.g()], display[color.b()], color.a());
        held = array;
        return held;
    }
    _accessors.document().take(accessor.count * 32, accessor.place);
    std::vector<float> values(accessor.count * accessor.components);
    _accessors.copyFloats(accessor, values.data());
    const osg::ref_ptr<osg::Vec4Array> array =
        new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, count);
    for (std::size_t i = 0; i < accessor.count; ++i)
    {
        const float* v = values.data() + i * accessor.components;
        (*array)[i] =
            displayColor(osg::Vec4(v[0], v[1], v[2], accessor.components == 4 ? v[3] : 1.0f));
    }
    held = array;
    return held;
}

JointSet VertexReader::jointSet(const JsonPlace& attributes, std::size_t set)
{
    const std::string number = std::to_string(set);
    const JsonPlace index = attributes.at(("JOINTS_" + number).c_str());
    const Accessor accessor = _accessors.open(index, 4);
    JointSet result;
    result.weights = floats<osg::Vec4Array>(attributes.at(("WEIGHTS_" + number).c_str()));
    _accessors.document().take(accessor.count * 16, accessor.place);
    result.joints.resize(accessor.count);
    if (accessor.type == ComponentType::UnsignedShort)
    {
        _accessors.copy(accessor, result.joints.data());
        return result;
    }
    if (accessor.type != ComponentType::UnsignedByte)
        accessor.place.refuse("has joints that are neither unsigned bytes nor unsigned shorts");
    std::vector<unsigned char> bytes(accessor.count * 4);
    _accessors.copy(accessor, bytes.data());
    for (std::size_t i = 0; i < bytes.size(); ++i)
        result.joints[i / 4][i % 4] = bytes[i];
    return result;
}

std::vector<MorphTarget> VertexReader::targets(const JsonPlace& primitive)
{
    std::vector<MorphTarget> result;
    const std::size_t count = primitive.sizeOf("targets");
    if (count > kMostTargets) primitive.at("targets").refuse("has more than 1024 elements");
    for (std::size_t i = 0; i < count; ++i)
    {
        const JsonPlace target = primitive.at("targets")[i];
        MorphTarget read;
        if (const auto index = target.find("POSITION"))
            read.positions = floats<osg::Vec3Array>(*index);
        if (const auto index = target.find("NORMAL")) read.normals = floats<osg::Vec3Array>(*index);
        result.push_back(read);
    }
    return result;
}

void VertexReader::readTargetTangents(const JsonPlace& primitive, Vertices& vertices)
{
    for (std::size_t i = 0; i < vertices.targets.size(); ++i)
    {
        const auto index = primitive.at("targets")[i].find("TANGENT");
        if (!index) continue;
        if (!vertices.tangents)
        {
            // Without normals, tangents of targets are to be ignored [glTF20, sect. 3.7.2.2].
            if (primitive.at("attributes").find("NORMAL"))
                _accessors.document().note(
                    primitive.path() + ": has tangents of targets, but none of its own; rays have "
                                       "tangents made of the moved vertices");
            return;
        }
        MorphTarget& target = vertices.targets[i];
        target.tangents = floats<osg::Vec3Array>(*index);
        checkCount(target.tangents.get(), "a target's TANGENT", vertices.count(), primitive);
    }
}

osg::ref_ptr<osg::PrimitiveSet> VertexReader::primitives(const JsonPlace& primitive,
                                                         std::size_t vertices)
{
    const std::uint64_t number = primitive.wholeOr("mode", kTriangles);
    if (number > kTriangleFan) primitive.at("mode").refuse("is no mode of primitives");
    const auto mode = static_cast<GLenum>(_draco.isOpen() ? kTriangles : number);
    const auto index = primitive.find("indices");
    const auto whole = [&](std::size_t count)
    {
        const std::size_t used = vertices == 0 ? 0 : wholeCount(mode, count);
        if (used < count || used == 0)
            _accessors.document().note(primitive.path() + ": " + std::to_string(count - used) +
                                       " vertices make no whole primitive, and are left out");
        return used;
    };
    if (!index)
    {
        const std::size_t used = whole(vertices);
        return used == 0 ? nullptr : new osg::DrawArrays(mode, 0, static_cast<GLsizei>(used));
    }
    const Accessor accessor = _accessors.open(*index, 1);
    if (whole(accessor.count) == 0) return nullptr;
    osg::ref_ptr<osg::PrimitiveSet>& held = _primitives[{index->index(SIZE_MAX), mode, vertices}];
    if (held) return held;
    _accessors.document().take(accessor.count * accessor.elementSize(), accessor.place);
    switch (accessor.type)
    {
    case ComponentType::UnsignedByte:
        held = drawElements<osg::DrawElementsUByte>(_accessors, accessor, mode, vertices);
        break;
    case ComponentType::UnsignedShort:
        held = drawElements<osg::DrawElementsUShort>(_accessors, accessor, mode, vertices);
        break;
    case ComponentType::UnsignedInt:
        held = drawElements<osg::DrawElementsUInt>(_accessors, accessor, mode, vertices);
        break;
    default:
        accessor.place.refuse("has indices that are no unsigned integers");
    }
    return held;
}

/// Refuses attributes that are not one for each vertex.
void VertexReader::checkCounts(const Vertices& vertices, const JsonPlace& primitive) const
{
    const std::size_t count = vertices.count();
    const auto check = [&](const osg::Array* array, const char* name)
    { checkCount(array, name, count, primitive); };
    check(vertices.normals.get(), "NORMAL");
    check(vertices.tangents.get(), "TANGENT");
    check(vertices.colors.get(), "COLOR_0");
    for (const auto& texcoord : vertices.texcoords)
        check(texcoord.get(), "TEXCOORD");
    for (const JointSet& set : vertices.jointSets)
    {
        check(set.weights.get(), "WEIGHTS");
        if (set.joints.size() != count)
            primitive.refuse("has " + std::to_string(set.joints.size()) +
                             " elements of JOINTS for " + std::to_string(count) + " vertices");
    }
    for (const MorphTarget& target : vertices.targets)
    {
        check(target.positions.get(), "a target's POSITION");
        check(target.normals.get(), "a target's NORMAL");
    }
}

Vertices VertexReader::read(const JsonPlace& primitive)
{
    _draco.open(primitive);
    const JsonPlace attributes = primitive.at("attributes");
    const auto has = [&attributes](const std::string& name, std::size_t set)
    { return attributes.find((name + std::to_string(set)).c_str()); };
    Vertices vertices;
    vertices.positions = floats<osg::Vec3Array>(attributes.at("POSITION"));
    if (const auto index = attributes.find("NORMAL"))
        vertices.normals = floats<osg::Vec3Array>(*index);
    if (const auto index = attributes.find("TANGENT"))
        vertices.tangents = floats<osg::Vec4Array>(*index);
    for (std::size_t set = 0; set < kMostTexcoords; ++set)
    {
        const auto index = has("TEXCOORD_", set);
        if (!index) break;
        vertices.texcoords.push_back(floats<osg::Vec2Array>(*index, Role::Texcoord));
    }
    if (const auto index = attributes.find("COLOR_0")) vertices.colors = colors(*index);
    for (std::size_t set = 0; set < kMostJointSets && has("JOINTS_", set); ++set)
        vertices.jointSets.push_back(jointSet(attributes, set));
    vertices.targets = targets(primitive);
    checkCounts(vertices, primitive);
    vertices.primitives = primitives(primitive, vertices.count());
    return vertices;
}

} // namespace osgRayTrace::gltf
