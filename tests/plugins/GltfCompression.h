// GltfCompression.h - glTF models whose meshes and images are compressed, by the encoders of the
// libraries that the reader decodes them with. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/plugins/GltfFiles.h"

#include <array>
#include <cstdint>

namespace osgRayTrace::test
{

/// A square of cells x cells cells with a hill, whose vertices are told by their x and y, which are
/// whole numbers.
struct Grid
{
    std::vector<float> positions; ///< three a vertex
    std::vector<float> normals;   ///< three a vertex
    std::vector<float> texcoords; ///< two a vertex
    std::vector<std::uint32_t> indices;

    std::size_t count() const { return positions.size() / 3; }
};

Grid gridOf(int cells);

/// Returns the grid as a model whose buffers are not compressed.
Json plainModel(const Grid& grid);

#ifdef OSGRAYTRACE_TEST_DRACO
/// How a mesh is written.
struct DracoStyle
{
    int bits = 11;           ///< of each attribute
    bool edgebreaker = true; ///< that method changes the order of the vertices
    int speed = 5;           ///< below 4 texcoords are predicted from positions, if edgebreaker
    bool metadata = false;   ///< some, of the mesh and of an attribute
};

/// Returns the bytes of a mesh with the attributes 0 (positions), 1 (normals) and 2 (texcoords).
std::string dracoBytes(const Grid& grid, const DracoStyle& style);

/// Returns a model of which all is compressed by draco.
Json dracoModel(const Grid& grid, const std::string& bytes);
#endif

#ifdef OSGRAYTRACE_TEST_MESHOPT
std::string meshoptVertices(const void* vertices, std::size_t count, std::size_t stride);
std::string meshoptTriangles(const std::vector<std::uint32_t>& indices, std::size_t vertices);
std::string meshoptSequence(const std::vector<std::uint32_t>& indices, std::size_t vertices);

/// Adds a view of count * stride bytes that stand compressed in a buffer of their own; the view's
/// own buffer has none. Returns its number.
int addMeshoptView(Json& model, const std::string& compressed, std::size_t count,
                   std::size_t stride, const std::string& mode, const std::string& filter = "");

/// Returns a model with positions, normals, texcoords and indices compressed without loss.
Json meshoptModel(const Grid& grid, bool triangles);
#endif

#ifdef OSGRAYTRACE_TEST_WEBP
/// Returns a WebP picture without loss. rgba: four bytes a pixel, the first row at the top.
std::string webpBytes(const std::vector<unsigned char>& rgba, int width, int height);
#endif

} // namespace osgRayTrace::test
