// SceneTraits.h - what a scene needs, so that nothing else costs time. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

struct SceneTraits
{
    bool instances = false;     ///< some instance is placed by a transform
    bool smoothNormals = false; ///< some mesh has vertex normals
    bool textures = false;
    bool mipmaps = false; ///< some material looks a texture with mips up: see RayCones.h
    bool vertexColors = false;
    bool fog = false;           ///< some surface has OpenGL's fog
    bool blended = false;       ///< some surface lets light through by its alpha
    bool fixedFunction = false; ///< some material is FixedFunction
    bool physical = false;      ///< some material is Physical and more than a lamp
    bool specular = false;      ///< mirror-like reflection somewhere
    bool glossy = false;        ///< some metal has a narrow lobe: see Bsdf::isGlossy
    bool transmission = false; ///< some surface transmits light and is no mere boundary of a medium
    bool normalMaps = false;   ///< some texture decides on the normals of a surface or its coat
    bool panes = false;        ///< some surface lets light pass straight: see MaterialTable::pane
    bool attenuation = false;  ///< light is absorbed within some body
    bool media = false;        ///< rays need to know what they travel through: see MediumTable
    bool volumes = false;      ///< some image fills a box: see GridTable; media is then set, too
    bool veils = false;        ///< media dim what stands behind the scene for rays that hit nothing
    bool scattering = false;   ///< some medium scatters light
    bool glowing = false;      ///< some medium emits light
    bool deltaLights = false;  ///< directional or point lights
    bool areaLights = false;   ///< parallelogram or mesh lights
    bool environment = false;  ///< light from all around
    bool subsurface = false;   ///< light enters some body below a diffuse boundary
    bool ground = false;       ///< rays from the eye see shadows on the ground
    size_t triangles = 0;      ///< counted once for each instance
};

/// Returns whether some texture of the material but normal maps has mips.
bool isMipmapped(const Material& material, const Scene& scene);

/// Returns the traits of a scene. alike: traits of a scene with the same instances of the same
/// meshes; null: no such traits are known.
SceneTraits sceneTraits(const Scene& scene, const SceneTraits* alike = nullptr);

} // namespace osgRayTrace::engine
