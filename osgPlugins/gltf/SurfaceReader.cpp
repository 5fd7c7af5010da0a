// SurfaceReader.cpp - makes a state set of each material, once. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/SurfaceReader.h"

#include "osgPlugins/gltf/FixedFunction.h"
#include "osgPlugins/gltf/Physical.h"

namespace osgRayTrace::gltf
{

const MaterialValues& SurfaceReader::valuesOf(std::optional<std::size_t> material)
{
    const std::size_t key = material.value_or(SIZE_MAX);
    const auto held = _values.find(key);
    if (held != _values.end()) return held->second;
    const JsonPlace place =
        material ? _document->element("materials", *material) : JsonPlace::empty();
    return _values.emplace(key, materialValues(place, _textures, *_document)).first->second;
}

const Surface& SurfaceReader::read(std::optional<std::size_t> material, const SurfaceUse& use)
{
    const auto key = std::make_tuple(material.value_or(SIZE_MAX), use.colors, use.normals);
    const auto held = _surfaces.find(key);
    if (held != _surfaces.end()) return held->second;

    const MaterialValues& values = valuesOf(material);
    Surface surface;
    surface.states = new osg::StateSet;
    surface.lit = use.normals && !values.unlit;
    surface.color = values.baseColor;
    if (values.alphaMode == AlphaMode::Opaque) surface.color.a() = 1.0f;
    surface.usesTangents = surface.lit && (values.normalTexture || values.clearcoatNormalTexture ||
                                           values.anisotropy > 0.0f);
    setFixedFunction(values, use, surface);
    if (surface.lit)
        surface.states->setAttributeAndModes(physicalMaterial(values, use.colors).get());
    return _surfaces.emplace(key, std::move(surface)).first->second;
}

} // namespace osgRayTrace::gltf
