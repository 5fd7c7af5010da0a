// PicturePacket.h - what a picture is of as bytes, for processes that have no scene graph. Layer:
// public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/PictureText.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace
{

/// A picture as unpackedPicture() finds it in bytes.
struct UnpackedPicture
{
    std::string problem; ///< one sentence; empty: all the others are there
    std::shared_ptr<const engine::Scene> scene;
    std::vector<std::pair<std::string, std::string>> settings; ///< names and values
    osg::Matrixd view, projection;
    int width = 0, height = 0;
};

/// Returns the scene, the view and the settings of the picture, for processes of the same build.
std::vector<unsigned char> packedPicture(const PictureInputs& picture);

/// Reads such bytes, which nobody need trust. Throws std::bad_alloc.
UnpackedPicture unpackedPicture(const unsigned char* bytes, std::size_t size);

} // namespace osgRayTrace
