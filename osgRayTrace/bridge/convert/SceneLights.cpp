// SceneLights.cpp - finds the lights of OpenGL's numbers that shine, and all others. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneLights.h"

#include "osgRayTrace/bridge/convert/SceneVolumes.h"

#include "osgRayTrace/bridge/appearance/lights/EnvironmentImages.h"
#include "osgRayTrace/bridge/appearance/lights/LightConverter.h"
#include "osgRayTrace/bridge/appearance/materials/MediumConversion.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/LightSource>

#include <algorithm>
#include <map>
#include <string>

namespace osgRayTrace::engine
{

namespace
{

const char* const kHeadlight = "converted.headlight";
const char* const kSkyLight = "converted.sky-light";

/// Adds surfaces that emit, then area lights.
void addShining(Scene& scene, const std::vector<ConversionCaches::Quad>& quads)
{
    std::vector<bool> isQuad(quads.empty() ? 0 : scene.instances.size());
    for (const ConversionCaches::Quad& quad : quads)
        if (quad.instance != kInvalid) isQuad[quad.instance] = true;
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
    {
        Instance& instance = scene.instances[i];
        const Material& material = scene.materials[instance.material];
        instance.light = kInvalid;
        if (material.model != MaterialModel::Physical || material.emission == Vec3(0.0f)) continue;
        const Mesh& mesh = *scene.meshes[instance.mesh];
        if ((!isQuad.empty() && isQuad[i]) || mesh.triangles.empty()) continue;
        instance.light = static_cast<uint32_t>(scene.lights.size());
        scene.lights.push_back(meshLight(mesh.name, material.emission, i));
    }
    for (const ConversionCaches::Quad& quad : quads)
    {
        if (quad.instance == kInvalid || quad.light.radiance == Vec3(0.0f)) continue;
        scene.instances[quad.instance].light = static_cast<uint32_t>(scene.lights.size());
        scene.lights.push_back(quad.light);
        scene.lights.back().instance = quad.instance;
    }
}

/// Returns a material with the lights that any of the materials has enabled.
Material lightsOfAll(const std::vector<Material>& materials)
{
    Material all;
    all.lightMask = 0;
    for (const Material& material : materials)
    {
        if (!material.lit) continue;
        all.lightMask |= material.lightMask;
        if (all.moreLights.size() < material.moreLights.size())
            all.moreLights.resize(material.moreLights.size());
        for (std::size_t k = 0; k < material.moreLights.size(); ++k)
            all.moreLights[k] |= material.moreLights[k];
    }
    return all;
}

struct NumberedLight
{
    Light light;
    std::string path;
    bool ofGraph; ///< false: the viewer's own
};

/// Counts a light whose number a later light has.
void countReplaced(const NumberedLight& light, ConversionReport& report)
{
    if (!light.ofGraph) return; // the application did not place the viewer's light
    report.setPlace([&light] { return light.path; });
    report.count("unused.light-replaced");
    report.setPlace({});
}

/// Returns whether the scene has media that scatter and no surface but their boundaries: the state
/// of a surface enables lights.
bool hasMediaAlone(const Scene& scene, const LightSources& sources)
{
    const auto scatters = [](const osgRayTrace::Medium* medium)
    { return medium && medium->getScattering() != osg::Vec3(); };
    const bool inAir = std::any_of(sources.volumes.begin(), sources.volumes.end(),
                                   [&](const CollectedVolume& source)
                                   { return scatters(source.volume->getMedium()); });
    const bool inTiles =
        std::any_of(sources.tiles.begin(), sources.tiles.end(),
                    [&](const CollectedTile& source)
                    { return source.material && scatters(source.material->getInterior()); });
    bool inBodies = false;
    for (const Instance& instance : scene.instances)
    {
        if (scene.meshes[instance.mesh]->triangles.empty()) continue; // it was removed
        const Material& material = scene.materials[instance.material];
        if (!isInterface(material)) return false;
        inBodies = inBodies || material.detail->interior.sigmaS != Vec3(0.0f);
    }
    return inAir || inTiles || inBodies;
}

/// Adds lights as OpenGL keeps them: by number, the last one set stays, and a light that no surface
/// has enabled does nothing, unless there are media alone. The viewer's light is set before those
/// of the graph, and behind them come the lights that OpenGL does not get, which all stay.
void addNumbered(Scene& scene, const ConversionInput& input, const LightSources& sources,
                 ConversionReport& report)
{
    std::map<int, NumberedLight> lights;
    std::vector<Light> tracedLights;
    std::map<std::string, float> unused = input.lightSizes.byName;
    const auto add = [&](const osg::Light& source, const osg::Matrixd& matrix, bool eyeSpace,
                         const std::string& path, bool ofGraph)
    {
        const int number = source.getLightNum();
        auto light = convertLight(source, matrix, eyeSpace, scene.unit);
        const bool numbered = !isTracedLight(source);
        if (!light || (numbered && (number < 0 || number >= kLightNumbers)))
        {
            report.warn("skipped.light", "light '" + path + "'",
                        light ? "number is not 0 to " + std::to_string(kLightNumbers - 1) +
                                    ", which GL_LIGHT0 + number has modes for, skipped"
                              : "values are not finite, skipped");
            return;
        }
        const std::string sizedAs = applyLightSize(input.lightSizes, path, scene.unit, *light);
        if (!sizedAs.empty()) unused.erase(sizedAs);
        if (light->name.empty()) light->name = path;
        if (!numbered)
        {
            tracedLights.push_back(*std::move(light));
            return;
        }
        const auto before = lights.find(number);
        if (before != lights.end()) countReplaced(before->second, report);
        lights.insert_or_assign(number, NumberedLight{*std::move(light), path, ofGraph});
    };
    const double scale = 1.0 / scene.unit;
    const osg::Matrixd engineFromWorld =
        osg::Matrixd::translate(-input.origin) * osg::Matrixd::scale(scale, scale, scale);
    if (input.viewLight)
    {
        add(*input.viewLight, input.viewLightInEyeSpace ? osg::Matrixd() : engineFromWorld,
            input.viewLightInEyeSpace, "viewer", false);
        for (auto& [number, numbered] : lights)
            numbered.light.castsShadows = !input.viewLightInEyeSpace || input.headlightShadows;
    }
    for (const CollectedLight& light : sources.lights)
        if (light.source->getLight())
            add(*light.source->getLight(), light.engineFromLocal, light.eyeSpace, light.path, true);

    for (const auto& [name, size] : unused)
        report.warn("warned.light-size", "light-sizes '" + name + "'",
                    "there is no light of this name");

    const Material enabled = lightsOfAll(scene.materials);
    const bool mediaAlone = hasMediaAlone(scene, sources);
    for (auto& [number, numbered] : lights)
    {
        if (!mediaAlone && !isLightEnabled(enabled, numbered.light.number)) continue;
        scene.lights.push_back(std::move(numbered.light));
        if (!numbered.ofGraph) report.count(input.viewLightInEyeSpace ? kHeadlight : kSkyLight);
    }
    for (Light& light : tracedLights)
        scene.lights.push_back(std::move(light));
}

/// Returns a light that stands for environments that cannot be converted, so that nobody takes
/// darkness for their light.
Light magentaLight(const std::string& name)
{
    Light light;
    light.name = name;
    light.kind = LightKind::Environment;
    light.radiance = Vec3(1.0f);
    light.environment.image = magentaEnvironment();
    return light;
}

/// Adds the one sky of a scene: the first environment that can be converted.
void addEnvironment(Scene& scene, const std::vector<CollectedEnvironment>& sources,
                    EnvironmentConverter& converter, ConversionReport& report)
{
    bool found = false;
    for (const CollectedEnvironment& source : sources)
    {
        if (found)
        {
            report.warn("skipped.environment-light", "environment light '" + source.path + "'",
                        "the scene has one before it, skipped");
            continue;
        }
        const auto light = converter.convert(*source.light, source.engineFromLocal,
                                             !scene.displayReferred, source.path, report);
        found = light.has_value();
        if (found) scene.lights.push_back(*light);
    }
    if (!found && !sources.empty()) scene.lights.push_back(magentaLight(sources.front().path));
}

/// Sets the medium that fills the scene: that of the first volume that has one.
void setAtmosphere(Scene& scene, const std::vector<CollectedVolume>& sources,
                   ConversionReport& report)
{
    scene.atmosphere.reset();
    for (const CollectedVolume& source : sources)
    {
        if (!source.volume->getMedium() || scene.atmosphere)
        {
            report.warn("skipped.medium-volume", "medium volume '" + source.path + "'",
                        scene.atmosphere ? "the scene has one before it, skipped"
                                         : "it has no medium, skipped");
            continue;
        }
        Atmosphere atmosphere;
        atmosphere.medium = mediumOf(*source.volume->getMedium());
        const osg::Vec3d centre = source.engineFromLocal.getTrans();
        atmosphere.centre = Vec3(Vec3d(centre.x(), centre.y(), centre.z()));
        atmosphere.radius = static_cast<float>(double(source.volume->getRadius()) / scene.unit);
        if (source.volume->getShape() == MediumVolume::LAYER)
        {
            osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), source.engineFromLocal);
            up.normalize();
            atmosphere.up = Vec3(Vec3d(up.x(), up.y(), up.z()));
            atmosphere.scaleHeight =
                static_cast<float>(double(source.volume->getScaleHeight()) / scene.unit);
        }
        scene.atmosphere = std::make_shared<const Atmosphere>(atmosphere);
    }
}

} // namespace

void setLights(Scene& scene, const ConversionInput& input, const LightSources& sources,
               ConversionCaches& caches, ConversionReport& report)
{
    scene.lights.clear();
    addShining(scene, caches.areaLights);
    addNumbered(scene, input, sources, report);
    addEnvironment(scene, sources.environments, caches.environment, report);
    setAtmosphere(scene, sources.volumes, report);
    setVolumes(scene, sources.tiles, caches.volumes, report);
}

uint64_t viewerLights(const ConversionCounts& counts)
{
    return counts.count(kHeadlight) + counts.count(kSkyLight);
}

} // namespace osgRayTrace::engine
