// Extensions.cpp - the table of extensions. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Extensions.h"

#include "osgPlugins/gltf/DracoMesh.h"
#include "osgPlugins/gltf/MeshoptView.h"
#include "osgPlugins/gltf/WebpImage.h"

#include <algorithm>
#include <set>

namespace osgRayTrace::gltf
{

namespace
{

const char* const kRead[] = {
    "EXT_mesh_gpu_instancing",    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",    "KHR_materials_diffuse_transmission",
    "KHR_materials_iridescence",  "KHR_materials_sheen",
    "KHR_materials_specular",     "KHR_materials_volume",
    "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_variants",     "KHR_mesh_quantization",
    "KHR_texture_transform",
};

/// These change how a surface looks, and no more: a file that requires them is shown without.
const char* const kLeftOut[] = {
    "KHR_materials_dispersion",
};

template <std::size_t count>
bool contains(const char* const (&names)[count], const std::string& name)
{
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// Returns whether this build reads an extension: some need libraries that are optional.
bool isRead(const std::string& name)
{
    if (name == "KHR_draco_mesh_compression") return readsDraco();
    if (name == "EXT_meshopt_compression") return readsMeshopt();
    if (name == "EXT_texture_webp") return readsWebp();
    return contains(kRead, name);
}

} // namespace

void checkExtensions(Document& document)
{
    const JsonPlace root = document.root();
    for (std::size_t i = 0; i < root.sizeOf("extensionsRequired"); ++i)
    {
        const JsonPlace place = root.at("extensionsRequired")[i];
        if (!isRead(place.text()) && !contains(kLeftOut, place.text()))
            place.refuse("'" + place.text() + "' is required, and is not read");
    }
    std::set<std::string> ignored;
    for (std::size_t i = 0; i < root.sizeOf("extensionsUsed"); ++i)
    {
        const std::string& name = root.at("extensionsUsed")[i].text();
        if (!isRead(name)) ignored.insert(name);
    }
    std::string list;
    for (const std::string& name : ignored)
        list += (list.empty() ? "" : ", ") + name;
    if (!list.empty()) document.note("not read: " + list);
}

} // namespace osgRayTrace::gltf
