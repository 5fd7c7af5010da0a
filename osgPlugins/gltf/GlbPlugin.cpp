// GlbPlugin.cpp - osgdb_glb: OSG looks for it when a name ends in .glb. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include <osgDB/Registry>

namespace
{

/// Loads the plugin that reads both kinds of files.
struct LoadGltf
{
    LoadGltf()
    {
        osgDB::Registry* registry = osgDB::Registry::instance();
        registry->loadLibrary(registry->createLibraryNameForExtension("gltf"));
    }
};

const LoadGltf loadGltf;

} // namespace
