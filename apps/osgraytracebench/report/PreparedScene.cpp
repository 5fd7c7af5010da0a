// PreparedScene.cpp - graph to session, the public way. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/PreparedScene.h"

#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"

#include <osg/Light>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

/// Computes FNV-1a over the bytes of plain values.
class Hasher
{
public:
    template <typename T> void add(const T& value)
    {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "no padding");
        const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
        for (std::size_t i = 0; i < sizeof value; ++i)
            _value = (_value ^ bytes[i]) * 0x100000001b3ull;
    }
    template <int n> void add(const glm::vec<n, float>& v)
    {
        for (int i = 0; i < n; ++i)
            add(v[i]);
    }
    template <int n> void add(const glm::vec<n, uint32_t>& v)
    {
        for (int i = 0; i < n; ++i)
            add(v[i]);
    }
    template <int c, int r, typename T> void add(const glm::mat<c, r, T>& matrix)
    {
        for (int i = 0; i < c * r; ++i)
            add(matrix[i / r][i % r]);
    }
    template <typename List> void addAll(const List& list)
    {
        add(list.size());
        for (std::size_t i = 0; i < list.size(); ++i)
            add(list[i]);
    }
    uint64_t value() const { return _value; }

private:
    uint64_t _value = 0xcbf29ce484222325ull;
};

void hashMapping(Hasher& hasher, const TextureMapping& mapping)
{
    hasher.add(mapping.coordinates);
    hasher.add(mapping.transformed);
    hasher.add(mapping.matrix);
    hasher.add(mapping.partly);
    hasher.add(mapping.own);
    hasher.add(mapping.ownMatrix);
}

/// Adds the state of fixed-function materials, and the members that let rays pass.
void hashState(Hasher& hasher, const Material& material)
{
    hasher.add(material.lit);
    hasher.add(material.twoSidedLighting);
    hasher.add(material.vertexColorUse);
    hasher.add(material.separateSpecular);
    hasher.add(material.localViewer);
    hasher.add(material.hasBack);
    const FaceColors& back = material.back;
    for (const Vec3& color : {back.ambient, back.diffuse, back.specular, back.emission})
        hasher.add(color);
    hasher.add(back.shininess);
    hasher.add(back.alpha);

    hasher.add(material.textureEnvironment);
    hasher.add(material.environmentColor);
    hashMapping(hasher, material.mapping);
    hasher.add(material.second.texture);
    hasher.add(material.second.environment);
    hasher.add(material.second.environmentColor);
    hashMapping(hasher, material.second.mapping);

    hasher.add(material.blended);
    hasher.add(material.alphaTest);
    hasher.add(material.alphaReference);
    hasher.add(material.culling);
    hasher.add(material.cullsAllRays);
    hasher.add(material.clockwise);
}

void hashDetail(Hasher& hasher, const MaterialDetail& detail)
{
    hasher.add(detail.vertexColors);
    hasher.add(detail.thinWalled);
    for (const Vec3& color : {detail.attenuationColor, detail.specularColor, detail.sheenColor,
                              detail.diffuseTransmissionColor})
        hasher.add(color);
    for (const float value :
         {detail.attenuationDistance, detail.specular, detail.clearcoat, detail.clearcoatRoughness,
          detail.clearcoatNormalScale, detail.sheenRoughness, detail.normalScale, detail.anisotropy,
          detail.anisotropyRotation, detail.diffuseTransmission, detail.iridescence,
          detail.iridescenceIor, detail.iridescenceThickness.x, detail.iridescenceThickness.y})
        hasher.add(value);
    for (const uint32_t texture : detail.textures)
        hasher.add(texture);
    for (const TexturePlace& place : detail.places)
    {
        hasher.add(place.set);
        for (const Vec2& v : {place.u, place.v, place.offset})
        {
            hasher.add(v.x);
            hasher.add(v.y);
        }
    }
}

void hashMaterial(Hasher& hasher, const Material& material)
{
    for (const Vec3& color : {material.ambient, material.diffuse, material.specular,
                              material.baseColor, material.emission})
        hasher.add(color);
    for (const float value : {material.shininess, material.metallic, material.roughness,
                              material.transmission, material.ior, material.alpha})
        hasher.add(value);
    for (const uint32_t index :
         {material.lightMask, material.baseColorTexture, material.metallicRoughnessTexture,
          material.transmissionTexture, material.emissionTexture})
        hasher.add(index);
    for (const uint32_t lights : material.moreLights)
        hasher.add(lights);
    hasher.add(material.model);
    if (material.detail) hashDetail(hasher, *material.detail);
    hashState(hasher, material);
}

void hashTexture(Hasher& hasher, const Texture& texture)
{
    for (const int value : {texture.width, texture.height, texture.depth})
        hasher.add(value);
    for (const bool flag : {texture.cube, texture.hasColor, texture.hasAlpha, texture.decodeSrgb,
                            texture.linearFilter})
        hasher.add(flag);
    hasher.add(texture.wrapS);
    hasher.add(texture.wrapT);
    hasher.add(texture.wrapR);
    hasher.add(texture.border);
    hasher.addAll(texture.bytes);
    hasher.addAll(texture.floats);
    if (texture.mips.empty()) return;
    hasher.add(texture.blendsMips);
    hasher.add(texture.mips.size());
    for (const Texture& mip : texture.mips)
        hashTexture(hasher, mip);
}

void hashLight(Hasher& hasher, const Light& light)
{
    hasher.add(light.kind);
    for (const Vec3& v : {light.ambient, light.diffuse, light.specular, light.position,
                          light.direction, light.corner, light.edgeU, light.edgeV, light.radiance})
        hasher.add(v);
    for (const float value :
         {light.attenuationConstant, light.attenuationLinear, light.attenuationQuadratic,
          light.range, light.spotExponent, light.spotCosCutoff, light.radius, light.sine})
        hasher.add(value);
    hasher.add(light.eyeSpace);
    hasher.add(light.castsShadows);
    hasher.add(light.twoSided);
    hasher.add(light.environment.visible);
    hasher.add(light.environment.mapFromEngine);
    if (!light.environment.image) return;
    hasher.add(light.environment.image->width);
    hasher.addAll(light.environment.image->radiance);
}

void hashScene(Hasher& hasher, const Scene& scene)
{
    for (const auto& mesh : scene.meshes)
    {
        hasher.addAll(mesh->positions);
        hasher.addAll(mesh->triangles);
        hasher.addAll(mesh->normals);
        hasher.addAll(mesh->uvs);
        hasher.addAll(mesh->uvs1);
        hasher.addAll(mesh->rs);
        hasher.addAll(mesh->rs1);
        hasher.addAll(mesh->colors);
        hasher.addAll(mesh->tangents);
    }
    for (const Instance& instance : scene.instances)
    {
        hasher.add(instance.mesh);
        hasher.add(instance.material);
        if (!instance.placed) continue;
        hasher.add(instance.engineFromLocal.linear);
        hasher.add(instance.engineFromLocal.translation);
    }
    for (const Material& material : scene.materials)
        hashMaterial(hasher, material);
    for (const auto& texture : scene.textures)
        hashTexture(hasher, *texture);
    for (const Light& light : scene.lights)
        hashLight(hasher, light);
    hasher.add(scene.ambient);
    hasher.add(scene.background);
    hasher.add(scene.displayReferred);
}

osg::ref_ptr<osg::Light> headlight()
{
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(0.8f, 0.8f, 0.8f, 1.0f));
    light->setSpecular(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    return light;
}

} // namespace

int heightOf(const ReportScene& scene, int width)
{
    return std::max(1, static_cast<int>(std::lround(width / scene.aspect)));
}

PreparedScene prepare(const ReportScene& scene, const Placement& placement, int width,
                      std::shared_ptr<Workers> workers)
{
    osg::ref_ptr<osg::MatrixTransform> world = new osg::MatrixTransform(placement.worldFromScene);
    world->addChild(scene.graph.get());
    const osg::Matrixd viewFromWorld = osg::Matrixd::inverse(placement.worldFromScene) * scene.view;

    PreparedScene result;
    result.workers = std::move(workers);
    result.view = viewFromMatrices(viewFromWorld, scene.projection, width, heightOf(scene, width));
    ConversionInput input;
    input.root = world.get();
    input.eye = osg::Matrixd::inverse(viewFromWorld).getTrans();
    input.origin = input.eye;
    input.clearColor = scene.clearColor;
    input.lightSizes = scene.lightSizes;
    if (scene.headlight) input.viewLight = headlight();
    result.buildSeconds = secondsOf(
        [&] {
            result.traced =
                TracedScene::build(SceneConverter().convert(input).scene, result.workers);
        });
    return result;
}

uint64_t hashOf(const PreparedScene& prepared, const Method& method)
{
    Hasher hasher;
    hashScene(hasher, prepared.traced->scene());
    hasher.add(prepared.view.viewFromWorld);
    hasher.add(prepared.view.clipFromView);
    hasher.add(prepared.view.width);
    hasher.add(prepared.view.height);
    hasher.add(method.options.integrator);
    hasher.add(method.options.lightSampling);
    hasher.add(method.options.lightSamples);
    hasher.add(method.options.environmentSampling);
    hasher.add(method.options.environmentSamples);
    hasher.add(method.options.maxBounces);
    hasher.add(method.options.photons);
    hasher.add(method.options.photonRadius);
    hasher.add(method.options.photonAlpha);
    hasher.add(method.options.radiusSchedule);
    hasher.add(method.options.photonGuiding);
    return hasher.value();
}

std::unique_ptr<RenderSession> newSession(const PreparedScene& scene, const Method& method,
                                          uint32_t seed)
{
    auto session = std::make_unique<RenderSession>(scene.workers);
    RenderOptions options = method.options;
    options.seed = seed;
    session->setScene(scene.traced);
    session->setView(scene.view);
    session->setOptions(options);
    return session;
}

RenderProgress renderOn(RenderSession& session, const StopRule& rule)
{
    const RenderProgress progress = session.render(rule);
    if (!progress.status.ok()) throw EngineError(progress.status.code, progress.status.message);
    return progress;
}

Pixels pixelsOf(const RenderSession& session)
{
    const std::vector<float> rgba = session.resolveRadiance();
    Pixels pixels{session.width(), session.height(), {}};
    pixels.rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        pixels.rgb.insert(pixels.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    return pixels;
}

} // namespace osgRayTrace::bench
