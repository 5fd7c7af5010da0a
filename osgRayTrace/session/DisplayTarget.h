// DisplayTarget.h - where display values go while an image is made. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/ToneMap.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Where display values go while an image is made: see RenderSession::resolveDisplay. For an image
/// of the size of the session's view.
struct DisplayTarget
{
    ToneMap toneMap;
    uint8_t* rgba = nullptr;
    float* depth = nullptr; ///< may be null
    /// The image as it was before render() is there: only tiles that get a pass are written. Of an
    /// image without any pass that is whatever shall be seen where there is no tile yet.
    bool holdsImage = false;
    ChangedTiles* changed =
        nullptr; ///< gets a mark for each tile that is written; of that size; may be null
};

} // namespace osgRayTrace::engine
