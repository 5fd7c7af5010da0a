// DracoBounds.h - numbers in draco's bytes by which the library takes memory and time, looked up
// before it does. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <draco/core/decoder_buffer.h>

#include <cstdint>
#include <optional>

namespace osgRayTrace::gltf
{

/// The numbers at the beginning of a mesh's connectivity.
struct DracoCounts
{
    std::uint64_t faces = 0, points = 0;
    std::uint64_t seamAttributes = 0; ///< attributes with a corner table of their own
};

/// Returns the counts of a mesh of bitstream 2.2, which glTF asks for. bytes: from the connectivity
/// on. Returns nothing if the bytes end before, or are of another version.
std::optional<DracoCounts> dracoCounts(draco::DecoderBuffer bytes, bool edgebreaker);

/// Returns whether metadata, which glTF has no use for, are whole and small: the library puts as
/// many places on a stack as each of nested nodes says that it has children. bytes: behind the
/// header of a mesh that says it has metadata.
bool isSmallDracoMetadata(draco::DecoderBuffer bytes);

/// Returns whether an attribute that is predicted from positions has no more orientations of
/// triangles than values: the library takes memory for as many as are said, and reads each of them
/// from next to no bytes. bytes: behind the attribute's prediction method and transform. True for
/// other methods, and where the values themselves cannot be read.
bool dracoOrientationsFit(draco::DecoderBuffer bytes, std::uint32_t values,
                          std::uint8_t components);

} // namespace osgRayTrace::gltf
