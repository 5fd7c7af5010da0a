// DisplayTarget.h - where display values go while an image is made. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/ToneMap.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// A display target is where display values of an image of the session's view go while the image is
/// made: see RenderSession::resolveDisplay. The image has the size of the view.
struct DisplayTarget
{
    ToneMap toneMap;
    uint8_t* rgba = nullptr;
    float* depth = nullptr; ///< window depths; may be null
    /// True if the target holds the image as it was before render(): only tiles that get a pass are
    /// written. If that image has no pass, the target holds what shall be seen where there is no
    /// tile yet.
    bool holdsImage = false;
    ChangedTiles* changed =
        nullptr; ///< marks of the written tiles, of the image's size; may be null
};

} // namespace osgRayTrace::engine
