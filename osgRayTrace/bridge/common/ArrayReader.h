// ArrayReader.h - reads osg::Arrays of any numeric type row by row. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <osg/Array>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace osgRayTrace::engine
{

/// Tells whether integers are taken as they are (positions) or as OpenGL takes colours and normals,
/// whose largest value is 1.
enum class IntegerMeaning
{
    Plain,
    Normalized,
};

/// Returns whether forEachRow can read the array: it has 1 to 4 numbers an element.
inline bool isReadable(const osg::Array* array)
{
    if (!array || array->getNumElements() == 0 || !array->getDataPointer()) return false;
    if (array->getDataSize() < 1 || array->getDataSize() > 4) return false;
    switch (array->getDataType())
    {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE:
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT:
    case GL_DOUBLE:
        return true;
    default:
        return false;
    }
}

/// Returns the elements as tightly packed rows of T, or null if the array has another layout.
template <class T> const T* rowsOf(const osg::Array& array)
{
    const bool same = array.getDataType() == GL_FLOAT && array.getElementSize() == sizeof(T) &&
                      array.getDataSize() == static_cast<GLint>(sizeof(T) / sizeof(float));
    return same ? static_cast<const T*>(array.getDataPointer()) : nullptr;
}

/// Selects the rows to read, and how integers are read.
struct RowSelection
{
    std::size_t count = 0;
    const uint32_t* rows = nullptr; ///< count row numbers; null: all rows from 0 on
    IntegerMeaning integers = IntegerMeaning::Plain;
};

template <class Scalar, class Body>
void forEachRowOf(const osg::Array& array, const RowSelection& selection, const Body& body)
{
    const auto* first = static_cast<const Scalar*>(array.getDataPointer());
    const std::size_t stride = array.getElementSize() / sizeof(Scalar);
    const std::size_t size = array.getNumElements();
    const int components = array.getDataSize();
    const bool scaled =
        std::is_integral_v<Scalar> && selection.integers == IntegerMeaning::Normalized;
    const double scale =
        scaled ? 1.0 / static_cast<double>(std::numeric_limits<Scalar>::max()) : 1.0;
    const std::size_t count = selection.rows ? selection.count : std::min(selection.count, size);
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t index = selection.rows ? selection.rows[i] : i;
        if (index >= size) continue;
        const Scalar* row = first + index * stride;
        Vec4d value(0.0, 0.0, 0.0, 1.0);
        for (int c = 0; c < components; ++c)
            value[c] = static_cast<double>(row[c]) * scale;
        body(i, value);
    }
}

/// Calls body(i, value) for each selected row that exists; missing components are (0, 0, 0, 1) as
/// in OpenGL. The array must be readable.
template <class Body>
void forEachRow(const osg::Array& array, const RowSelection& selection, const Body& body)
{
    switch (array.getDataType())
    {
    case GL_BYTE:
        return forEachRowOf<GLbyte>(array, selection, body);
    case GL_UNSIGNED_BYTE:
        return forEachRowOf<GLubyte>(array, selection, body);
    case GL_SHORT:
        return forEachRowOf<GLshort>(array, selection, body);
    case GL_UNSIGNED_SHORT:
        return forEachRowOf<GLushort>(array, selection, body);
    case GL_INT:
        return forEachRowOf<GLint>(array, selection, body);
    case GL_UNSIGNED_INT:
        return forEachRowOf<GLuint>(array, selection, body);
    case GL_FLOAT:
        return forEachRowOf<GLfloat>(array, selection, body);
    case GL_DOUBLE:
        return forEachRowOf<GLdouble>(array, selection, body);
    default:
        return;
    }
}

} // namespace osgRayTrace::engine
