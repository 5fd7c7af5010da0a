// Scene.h - one immutable snapshot of everything that is traced. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Ground.h"
#include "osgRayTrace/scene/Light.h"
#include "osgRayTrace/scene/Material.h"
#include "osgRayTrace/scene/Medium.h"
#include "osgRayTrace/scene/Mesh.h"
#include "osgRayTrace/scene/Volume.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds plain data without behaviour. A new version of the scene is a new Scene that shares the
/// unchanged parts; the scene of a running pass never changes.
struct Scene
{
    // origin and unit lead from world to engine space: pEngine = (pWorld - origin) / unit.
    Vec3d origin{0.0}; ///< world position of the engine's origin
    double unit = 1.0; ///< [world length], a power of two; 1 unless floats would fail

    std::vector<std::shared_ptr<const Mesh>> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials; ///< never empty once finished: 0 is the fallback
    std::vector<std::shared_ptr<const Texture>> textures;
    std::vector<Light> lights;
    std::shared_ptr<const Atmosphere> atmosphere; ///< null: see atmosphereOf
    FogUse fogUse = FogUse::Depth;
    float ground = kNoGround;    ///< height of the plane that shows shadows alone [engine units]
    std::vector<Volume> volumes; ///< at most kMostVolumes

    Vec3 ambient{0.2f};    ///< LightModel ambient, for FixedFunction materials
    Vec4 background{0.0f}; ///< RGBA that rays see which leave the scene; not a light
    bool displayReferred =
        true; ///< true: values are as OpenGL shows them, neither decoded nor encoded

    Stamp changed = 0;
};

} // namespace osgRayTrace::engine
