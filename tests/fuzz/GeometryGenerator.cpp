// GeometryGenerator.cpp - geometries that OpenGL and the converter should refuse, and some that are
// right. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GeometryGenerator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace osgRayTrace::test
{

namespace
{

constexpr GLenum kModes[] = {GL_TRIANGLES,
                             GL_TRIANGLES,
                             GL_TRIANGLES,
                             GL_TRIANGLE_STRIP,
                             GL_TRIANGLE_FAN,
                             GL_QUADS,
                             GL_QUAD_STRIP,
                             GL_POLYGON,
                             GL_LINES,
                             GL_POINTS,
                             GL_LINE_LOOP,
                             GL_LINES_ADJACENCY,
                             GL_PATCHES,
                             GL_TRIANGLES_ADJACENCY,
                             0x77u};

constexpr int kSizes[] = {0, 1, 2, 3, 4, 5, 8, 13, 40, 200};

/// Returns a number of elements, or of a first element, as callers get it wrong.
int strangeCount(Dice& dice, int usual)
{
    constexpr int kStrange[] = {
        -1, 0, 1, 2, 1000000, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    if (dice.oneIn(12)) return dice.oneOf(kStrange);
    return dice.below(usual + 2);
}

template <class ArrayType> osg::ref_ptr<osg::Array> arrayOf(Dice& dice, int size, int rarity)
{
    using Element = typename ArrayType::ElementDataType;
    osg::ref_ptr<ArrayType> array = new ArrayType;
    const int components = array->getDataSize();
    for (int i = 0; i < size; ++i)
    {
        Element element;
        for (int c = 0; c < components; ++c)
        {
            using Scalar = std::decay_t<decltype(element[c])>;
            if constexpr (std::is_integral_v<Scalar>)
                element[c] = static_cast<Scalar>(dice.bits());
            else if constexpr (std::is_same_v<Scalar, float>)
            {
                const double value = dice.strange(2.0, rarity);
                element[c] = std::fabs(value) > 3.5e38 ? std::numeric_limits<float>::infinity()
                                                       : static_cast<float>(value);
            }
            else
                element[c] = dice.strange(2.0, rarity);
        }
        array->push_back(element);
    }
    return array;
}

osg::ref_ptr<osg::Array> scalarArray(Dice& dice, int size, int rarity)
{
    osg::ref_ptr<osg::FloatArray> array = new osg::FloatArray;
    for (int i = 0; i < size; ++i)
        array->push_back(static_cast<float>(std::clamp(dice.strange(2.0, rarity), -3e38, 3e38)));
    return array;
}

osg::ref_ptr<osg::Array> matrixArray(int size)
{
    osg::ref_ptr<osg::MatrixfArray> array = new osg::MatrixfArray;
    array->resize(static_cast<std::size_t>(size));
    return array;
}

osg::ref_ptr<osg::Array> oddArray(Dice& dice, int size, int rarity)
{
    switch (dice.below(14))
    {
    case 0:
        return arrayOf<osg::Vec2Array>(dice, size, rarity);
    case 1:
        return arrayOf<osg::Vec4Array>(dice, size, rarity);
    case 2:
        return arrayOf<osg::Vec3dArray>(dice, size, rarity);
    case 3:
        return arrayOf<osg::Vec4dArray>(dice, size, rarity);
    case 4:
        return arrayOf<osg::Vec2dArray>(dice, size, rarity);
    case 5:
        return arrayOf<osg::Vec3sArray>(dice, size, rarity);
    case 6:
        return arrayOf<osg::Vec3bArray>(dice, size, rarity);
    case 7:
        return arrayOf<osg::Vec4ubArray>(dice, size, rarity);
    case 8:
        return arrayOf<osg::Vec4usArray>(dice, size, rarity);
    case 9:
        return arrayOf<osg::Vec3iArray>(dice, size, rarity);
    case 10:
        return arrayOf<osg::Vec2uiArray>(dice, size, rarity);
    case 11:
        return scalarArray(dice, size, rarity);
    case 12:
        return matrixArray(size);
    default:
        return nullptr;
    }
}

/// Returns an array of the usual type or another, and of as many elements as there are vertices or
/// another number.
template <class Usual> osg::ref_ptr<osg::Array> attributeArray(Dice& dice, int vertices, int rarity)
{
    const int size = dice.oneIn(6) ? dice.oneOf(kSizes) : vertices;
    osg::ref_ptr<osg::Array> array =
        dice.oneIn(5) ? oddArray(dice, size, rarity) : arrayOf<Usual>(dice, size, rarity);
    if (!array) return nullptr;
    constexpr osg::Array::Binding kBindings[] = {
        osg::Array::BIND_PER_VERTEX, osg::Array::BIND_PER_VERTEX,
        osg::Array::BIND_OVERALL,    osg::Array::BIND_PER_PRIMITIVE_SET,
        osg::Array::BIND_OFF,        osg::Array::BIND_UNDEFINED};
    array->setBinding(dice.oneOf(kBindings));
    array->setNormalize(dice.oneIn(2));
    if (dice.oneIn(6)) array->setDataVariance(osg::Object::DYNAMIC);
    return array;
}

template <class Elements> osg::ref_ptr<osg::PrimitiveSet> indexSet(Dice& dice, int vertices)
{
    osg::ref_ptr<Elements> set = new Elements(dice.oneOf(kModes));
    const int count = dice.below(3 * vertices + 7);
    const bool wrong = dice.oneIn(4);
    for (int i = 0; i < count; ++i)
    {
        const bool beyond = vertices == 0 || (wrong && dice.oneIn(8));
        const uint32_t index = beyond ? dice.bits() : static_cast<uint32_t>(dice.below(vertices));
        set->push_back(static_cast<typename Elements::vector_type::value_type>(index));
    }
    return set;
}

osg::ref_ptr<osg::PrimitiveSet> randomSet(Dice& dice, int vertices)
{
    const GLenum mode = dice.oneOf(kModes);
    switch (dice.below(7))
    {
    case 0:
    case 1:
        return indexSet<osg::DrawElementsUInt>(dice, vertices);
    case 2:
        return indexSet<osg::DrawElementsUShort>(dice, vertices);
    case 3:
        return indexSet<osg::DrawElementsUByte>(dice, vertices);
    case 4:
    {
        const int first = dice.oneIn(3) ? strangeCount(dice, vertices) : 0;
        return new osg::DrawArrays(mode, first, strangeCount(dice, vertices),
                                   dice.oneIn(9) ? dice.below(5) - 1 : 0);
    }
    case 5:
    {
        osg::ref_ptr<osg::DrawArrayLengths> set = new osg::DrawArrayLengths(mode);
        set->setFirst(dice.oneIn(4) ? strangeCount(dice, vertices) : 0);
        for (int i = dice.below(5); i > 0; --i)
            set->push_back(strangeCount(dice, vertices / 2));
        return set;
    }
    default:
    {
        osg::ref_ptr<osg::MultiDrawArrays> set = new osg::MultiDrawArrays(mode);
        for (int i = dice.below(4); i > 0; --i)
            set->add(strangeCount(dice, vertices), strangeCount(dice, vertices));
        if (dice.oneIn(5)) set->getFirsts().push_back(0);
        return set;
    }
    }
}

uint64_t trianglesOfRange(GLenum mode, int64_t count)
{
    const auto n = static_cast<uint64_t>(std::max<int64_t>(count, 0));
    if (mode == GL_TRIANGLES) return n / 3;
    if (mode == GL_QUADS) return 2 * (n / 4);
    if (mode == GL_QUAD_STRIP) return n >= 4 ? (n - 2) / 2 * 2 : 0;
    const bool chain = mode == GL_TRIANGLE_STRIP || mode == GL_TRIANGLE_FAN || mode == GL_POLYGON;
    return chain && n >= 3 ? n - 2 : 0;
}

} // namespace

osg::ref_ptr<osg::Geometry> randomGeometry(Dice& dice)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const int vertices = dice.oneOf(kSizes);
    // Half of the geometries have only right values; otherwise every geometry of many vertices
    // would have a bad one.
    const int rarity = dice.oneIn(2) ? 1 << 30 : 4 + dice.below(60);
    if (dice.oneIn(12))
        geometry->setVertexAttribArray(0, arrayOf<osg::Vec3Array>(dice, vertices, rarity));
    else
        geometry->setVertexArray(dice.oneIn(8) ? oddArray(dice, vertices, rarity)
                                               : arrayOf<osg::Vec3Array>(dice, vertices, rarity));
    if (dice.oneIn(2))
        geometry->setNormalArray(attributeArray<osg::Vec3Array>(dice, vertices, rarity));
    if (dice.oneIn(2))
        geometry->setColorArray(attributeArray<osg::Vec4Array>(dice, vertices, rarity));
    if (dice.oneIn(2))
        geometry->setTexCoordArray(0, attributeArray<osg::Vec2Array>(dice, vertices, rarity));
    if (dice.oneIn(6)) geometry->setDataVariance(osg::Object::DYNAMIC);
    for (int i = dice.oneIn(3) ? dice.below(5) : 1; i > 0; --i)
        geometry->addPrimitiveSet(randomSet(dice, vertices));
    return geometry;
}

uint64_t trianglesOfSets(const osg::Geometry& geometry)
{
    uint64_t triangles = 0;
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i)
    {
        const osg::PrimitiveSet* set = geometry.getPrimitiveSet(i);
        const GLenum mode = set->getMode();
        if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(set))
            triangles += trianglesOfRange(mode, arrays->getCount());
        else if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(set))
            for (const GLsizei length : *lengths)
                triangles += trianglesOfRange(mode, length);
        else if (const auto* multi = dynamic_cast<const osg::MultiDrawArrays*>(set))
            for (std::size_t d = 0;
                 d < std::min(multi->getFirsts().size(), multi->getCounts().size()); ++d)
                triangles += trianglesOfRange(mode, multi->getCounts()[d]);
        else
            triangles += trianglesOfRange(mode, set->getNumIndices());
    }
    return triangles;
}

} // namespace osgRayTrace::test
