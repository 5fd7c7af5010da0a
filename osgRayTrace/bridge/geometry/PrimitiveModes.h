// PrimitiveModes.h - triangles and counts of OpenGL's primitive modes. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <osg/PrimitiveSet>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns the number of triangles that OpenGL makes of count vertices.
inline std::size_t triangleCount(GLenum mode, std::size_t count)
{
    switch (mode)
    {
    case GL_TRIANGLES:
        return count / 3;
    case GL_QUADS:
        return count / 4 * 2;
    case GL_TRIANGLE_STRIP:
    case GL_TRIANGLE_FAN:
    case GL_POLYGON:
        return count < 3 ? 0 : count - 2;
    case GL_QUAD_STRIP:
        return count < 4 ? 0 : (count / 2 - 1) * 2;
    default:
        return 0;
    }
}

/// Appends the triangles of a primitive set. index(i) is the vertex of the i-th corner. The corners
/// have the order of osg::TriangleIndexFunctor.
template <class Index>
void appendTriangles(GLenum mode, std::size_t count, const Index& index, std::vector<UVec3>& out)
{
    switch (mode)
    {
    case GL_TRIANGLES:
        for (std::size_t i = 0; i + 2 < count; i += 3)
            out.emplace_back(index(i), index(i + 1), index(i + 2));
        break;
    case GL_TRIANGLE_STRIP:
        for (std::size_t i = 0; i + 2 < count; ++i)
            out.emplace_back(index(i), index(i + 1 + i % 2), index(i + 2 - i % 2));
        break;
    case GL_TRIANGLE_FAN:
    case GL_POLYGON:
        for (std::size_t i = 1; i + 1 < count; ++i)
            out.emplace_back(index(0), index(i), index(i + 1));
        break;
    case GL_QUADS:
        for (std::size_t i = 0; i + 3 < count; i += 4)
        {
            out.emplace_back(index(i), index(i + 1), index(i + 2));
            out.emplace_back(index(i), index(i + 2), index(i + 3));
        }
        break;
    case GL_QUAD_STRIP:
        for (std::size_t i = 0; i + 3 < count; i += 2)
        {
            out.emplace_back(index(i), index(i + 1), index(i + 2));
            out.emplace_back(index(i + 1), index(i + 3), index(i + 2));
        }
        break;
    default:
        break;
    }
}

inline bool isPointOrLine(GLenum mode)
{
    return mode <= GL_LINE_STRIP; // GL_POINTS, GL_LINES, GL_LINE_LOOP, GL_LINE_STRIP
}

/// Returns why a mode has no triangles; null if it has triangles.
inline const char* untracedMode(GLenum mode)
{
    switch (mode)
    {
    case GL_TRIANGLES:
    case GL_TRIANGLE_STRIP:
    case GL_TRIANGLE_FAN:
    case GL_QUADS:
    case GL_QUAD_STRIP:
    case GL_POLYGON:
        return nullptr;
    case GL_POINTS:
        return "not-traced.points";
    case GL_LINES:
    case GL_LINE_STRIP:
    case GL_LINE_LOOP:
        return "not-traced.lines";
    case GL_PATCHES:
        return "not-traced.patches";
    default:
        return "not-traced.adjacency";
    }
}

/// Counts the calls of osg::TemplatePrimitiveFunctor: a quad is one primitive, as is each triangle
/// of a fan.
class PrimitiveCounter : public osg::PrimitiveIndexFunctor
{
public:
    explicit PrimitiveCounter(const osg::PrimitiveSet& set) { set.accept(*this); }

    uint32_t count() const { return static_cast<uint32_t>(_count); }

    static std::size_t countOf(GLenum mode, std::size_t vertices)
    {
        switch (mode)
        {
        case GL_POINTS:
            return vertices;
        case GL_LINES:
            return vertices / 2;
        case GL_LINE_STRIP:
            return vertices < 2 ? 0 : vertices - 1;
        case GL_LINE_LOOP:
            return vertices;
        case GL_LINE_STRIP_ADJACENCY:
            return vertices < 4 ? 0 : vertices - 3;
        case GL_TRIANGLES:
            return (vertices + 2) / 3;
        case GL_QUADS:
        case GL_QUAD_STRIP:
            return triangleCount(mode, vertices) / 2;
        default:
            return triangleCount(mode, vertices);
        }
    }

    void drawArrays(GLenum mode, GLint, GLsizei count) override { add(mode, count); }
    void drawElements(GLenum mode, GLsizei count, const GLubyte*) override { add(mode, count); }
    void drawElements(GLenum mode, GLsizei count, const GLushort*) override { add(mode, count); }
    void drawElements(GLenum mode, GLsizei count, const GLuint*) override { add(mode, count); }

    void setVertexArray(unsigned int, const osg::Vec2*) override {}
    void setVertexArray(unsigned int, const osg::Vec3*) override {}
    void setVertexArray(unsigned int, const osg::Vec4*) override {}
    void setVertexArray(unsigned int, const osg::Vec2d*) override {}
    void setVertexArray(unsigned int, const osg::Vec3d*) override {}
    void setVertexArray(unsigned int, const osg::Vec4d*) override {}

private:
    void add(GLenum mode, GLsizei count) { _count += countOf(mode, std::max(count, 0)); }

    std::size_t _count = 0;
};

} // namespace osgRayTrace::engine
