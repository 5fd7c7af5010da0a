// MaterialFile.cpp - hands a listing of materials to the application. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/MaterialFile>

#include "osgRayTrace/bridge/appearance/materials/MaterialListing.h"

namespace osgRayTrace
{

MaterialFile materialFileOf(osg::Node& scene)
{
    engine::MaterialListing listing = engine::listMaterials(scene);
    return {std::move(listing.text), listing.entries, listing.nameless, listing.complete};
}

} // namespace osgRayTrace
