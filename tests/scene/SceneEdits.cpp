// SceneEdits.cpp - a scene, and edits of each member that images depend on. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/scene/SceneEdits.h"

namespace osgRayTrace::engine::test
{

Scene someScene()
{
    Scene scene;
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = std::vector<Vec3>{Vec3(0.0f), Vec3(1.0f), Vec3(2.0f)};
    mesh->triangles = std::vector<UVec3>{UVec3(0, 1, 2)};
    scene.meshes.push_back(mesh);
    Instance instance;
    instance.placed = true;
    scene.instances.push_back(instance);
    Material material;
    material.detail = std::make_shared<MaterialDetail>();
    material.hasBack = true;
    material.mapping.transformed = material.mapping.partly = true;
    scene.materials.push_back(material);
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->bytes = {1, 2, 3, 4};
    scene.textures.push_back(texture);
    Light light;
    auto sky = std::make_shared<EnvironmentImage>();
    sky->width = sky->height = 1;
    sky->radiance = {Vec3(1.0f)};
    light.environment.image = sky;
    scene.lights.push_back(light);
    auto voxels = std::make_shared<VolumeImage>();
    voxels->width = voxels->height = voxels->depth = 1;
    voxels->bytes = {9};
    Volume volume;
    volume.image = voxels;
    volume.transfer = {Vec4(0.1f), Vec4(0.2f)};
    scene.volumes.push_back(volume);
    return scene;
}

Edit ofMesh(const std::function<void(Mesh&)>& edit)
{
    return [edit](Scene& scene)
    {
        auto mesh = std::make_shared<Mesh>(*scene.meshes[0]);
        edit(*mesh);
        scene.meshes[0] = mesh;
    };
}

namespace
{

Edit ofMaterial(const std::function<void(Material&)>& edit)
{
    return [edit](Scene& scene) { edit(scene.materials[0]); };
}

Edit ofDetail(const std::function<void(MaterialDetail&)>& edit)
{
    return [edit](Scene& scene)
    {
        auto detail = std::make_shared<MaterialDetail>(*scene.materials[0].detail);
        edit(*detail);
        scene.materials[0].detail = detail;
    };
}

} // namespace

Edit ofTexture(const std::function<void(Texture&)>& edit)
{
    return [edit](Scene& scene)
    {
        auto texture = std::make_shared<Texture>(*scene.textures[0]);
        edit(*texture);
        scene.textures[0] = texture;
    };
}

namespace
{

Edit ofLight(const std::function<void(Light&)>& edit)
{
    return [edit](Scene& scene) { edit(scene.lights[0]); };
}

Edit ofAtmosphere(const std::function<void(Atmosphere&)>& edit)
{
    return [edit](Scene& scene)
    {
        Atmosphere atmosphere;
        edit(atmosphere);
        scene.atmosphere = std::make_shared<const Atmosphere>(atmosphere);
    };
}

Edit ofVolume(const std::function<void(Volume&)>& edit)
{
    return [edit](Scene& scene) { edit(scene.volumes[0]); };
}

Edit ofVoxels(const std::function<void(VolumeImage&)>& edit)
{
    return [edit](Scene& scene)
    {
        auto image = std::make_shared<VolumeImage>(*scene.volumes[0].image);
        edit(*image);
        scene.volumes[0].image = image;
    };
}

} // namespace

std::vector<Edit> edits()
{
    return {
        [](Scene& s) { s.origin.x = 1.0; },
        [](Scene& s) { s.unit = 2.0; },
        [](Scene& s) { s.ambient.y = 0.5f; },
        [](Scene& s) { s.background.w = 1.0f; },
        [](Scene& s) { s.displayReferred = false; },
        [](Scene& s) { s.fogUse = FogUse::Off; },
        [](Scene& s) { s.ground = -1.0f; },
        ofAtmosphere([](Atmosphere&) {}),
        ofAtmosphere([](Atmosphere& a) { a.medium.sigmaS.y = 0.7f; }),
        ofAtmosphere([](Atmosphere& a) { a.centre.z = 0.7f; }),
        ofAtmosphere([](Atmosphere& a) { a.radius = 7.0f; }),
        ofAtmosphere([](Atmosphere& a) { a.scaleHeight = 0.7f; }),
        ofAtmosphere([](Atmosphere& a) { a.up = Vec3(0, 1, 0); }),
        [](Scene& s) { s.volumes.push_back(s.volumes[0]); },
        [](Scene& s) { s.volumes.clear(); },
        ofVoxels([](VolumeImage& v) { v.bytes = {10}; }),
        ofVoxels(
            [](VolumeImage& v)
            {
                v.width = 2;
                v.bytes = {10, 11};
            }),
        ofVoxels(
            [](VolumeImage& v)
            {
                v.channels = 4;
                v.floats = {0.1f, 0.2f, 0.3f, 0.4f};
                v.bytes.clear();
            }),
        ofVolume([](Volume& v) { v.transfer[1].w = 0.7f; }),
        ofVolume([](Volume& v) { v.transferScale = 2.0f; }),
        ofVolume([](Volume& v) { v.transferOffset = 0.1f; }),
        ofVolume([](Volume& v) { v.imageFromEngine.translation.y = 0.1f; }),
        ofVolume([](Volume& v) { v.tileFromEngine.linear[1][1] = 0.1f; }),
        ofVolume([](Volume& v) { v.law = VolumeLaw::Density; }),
        ofVolume([](Volume& v) { v.medium.sigmaA.z = 0.1f; }),
        ofVolume([](Volume& v) { v.transparency = 0.1f; }),
        ofVolume([](Volume& v) { v.cutoff = 0.1f; }),
        ofVolume([](Volume& v) { v.sampleRatio = 0.1f; }),
        ofVolume([](Volume& v) { v.sampleLength = 0.1f; }),
        ofVolume([](Volume& v) { v.lit = true; }),
        ofVolume([](Volume& v) { v.tint.x = 0.1f; }),
        [](Scene& s) { s.meshes.push_back(s.meshes[0]); },
        [](Scene& s) { s.instances.push_back(s.instances[0]); },
        [](Scene& s) { s.lights.push_back(s.lights[0]); },
        [](Scene& s) { s.instances[0].mesh = 1; },
        [](Scene& s) { s.instances[0].material = 1; },
        [](Scene& s) { s.instances[0].light = 1; },
        [](Scene& s) { s.instances[0].mirrored = true; },
        [](Scene& s) { s.instances[0].placed = false; },
        [](Scene& s) { reinterpret_cast<float&>(s.instances[0].engineFromLocal) = 3.0f; },
        ofMesh(
            [](Mesh& m) {
                m.positions = std::vector<Vec3>{Vec3(0.0f), Vec3(1.0f), Vec3(3.0f)};
            }),
        ofMesh([](Mesh& m) { m.triangles = std::vector<UVec3>{UVec3(0, 2, 1)}; }),
        ofMesh([](Mesh& m) { m.normals = std::vector<Vec3>(3, Vec3(0.0f, 0.0f, 1.0f)); }),
        ofMesh([](Mesh& m) { m.uvs = std::vector<Vec2>(3, Vec2(0.5f)); }),
        ofMesh([](Mesh& m) { m.uvs1 = std::vector<Vec2>(3, Vec2(0.5f)); }),
        ofMesh([](Mesh& m) { m.rs = std::vector<float>(3, 0.5f); }),
        ofMesh([](Mesh& m) { m.rs1 = std::vector<float>(3, 0.5f); }),
        ofMesh([](Mesh& m) { m.colors = std::vector<Vec4>(3, Vec4(0.5f)); }),
        ofMesh([](Mesh& m) { m.tangents = std::vector<Vec4>(3, Vec4(0.5f)); }),
        ofMesh([](Mesh& m) { m.moreUvs = {std::vector<Vec2>(3, Vec2(0.5f))}; }),
        ofMesh(
            [](Mesh& m) {
                m.moreUvs = {{}, std::vector<Vec2>(3, Vec2(0.5f))};
            }),
        ofMaterial([](Material& m) { m.model = MaterialModel::Physical; }),
        ofMaterial([](Material& m) { m.ambient.x = 0.7f; }),
        ofMaterial([](Material& m) { m.diffuse.x = 0.7f; }),
        ofMaterial([](Material& m) { m.specular.x = 0.7f; }),
        ofMaterial([](Material& m) { m.shininess = 7.0f; }),
        ofMaterial([](Material& m) { m.lit = false; }),
        ofMaterial([](Material& m) { m.twoSidedLighting = true; }),
        ofMaterial([](Material& m) { m.lightMask = 7; }),
        ofMaterial([](Material& m) { m.moreLights = {7}; }),
        ofMaterial([](Material& m) { m.vertexColorUse = VertexColorUse::Diffuse; }),
        ofMaterial([](Material& m) { m.textureEnvironment = TextureEnvironment::Decal; }),
        ofMaterial([](Material& m) { m.environmentColor.x = 0.7f; }),
        ofMaterial([](Material& m) { m.mapping.coordinates = TextureCoordinates::SphereMap; }),
        ofMaterial([](Material& m) { m.mapping.matrix[1][2] = 0.7f; }),
        ofMaterial([](Material& m) { m.mapping.own = TextureCoordinates::Uv1; }),
        ofMaterial([](Material& m) { m.mapping.ownMatrix[1][2] = 0.7f; }),
        ofMaterial([](Material& m) { m.second.texture = 0; }),
        ofMaterial([](Material& m) { m.second.environment = TextureEnvironment::Add; }),
        ofMaterial([](Material& m) { m.second.environmentColor.y = 0.7f; }),
        ofMaterial([](Material& m) { m.second.mapping.coordinates = TextureCoordinates::Uv1; }),
        ofMaterial([](Material& m) { m.second.mapping.transformed = true; }),
        ofMaterial([](Material& m) { m.separateSpecular = true; }),
        ofMaterial([](Material& m) { m.localViewer = true; }),
        ofMaterial([](Material& m) { m.back.emission.z = 0.7f; }),
        ofMaterial([](Material& m) { m.back.ambient.z = 0.7f; }),
        ofMaterial([](Material& m) { m.back.diffuse.z = 0.7f; }),
        ofMaterial([](Material& m) { m.back.specular.z = 0.7f; }),
        ofMaterial([](Material& m) { m.back.shininess = 7.0f; }),
        ofMaterial([](Material& m) { m.back.alpha = 0.7f; }),
        ofMaterial([](Material& m) { m.hasBack = false; }),
        ofMaterial([](Material& m) { m.baseColor.z = 0.7f; }),
        ofMaterial([](Material& m) { m.metallic = 0.7f; }),
        ofMaterial([](Material& m) { m.roughness = 0.7f; }),
        ofMaterial([](Material& m) { m.transmission = 0.7f; }),
        ofMaterial([](Material& m) { m.ior = 1.7f; }),
        ofMaterial([](Material& m) { m.emission.z = 0.7f; }),
        ofMaterial([](Material& m) { m.alpha = 0.7f; }),
        ofMaterial([](Material& m) { m.blended = true; }),
        ofMaterial([](Material& m) { m.alphaTest = AlphaTest::Less; }),
        ofMaterial([](Material& m) { m.alphaReference = 0.7f; }),
        ofMaterial([](Material& m) { m.culling = FaceCulling::Back; }),
        ofMaterial([](Material& m) { m.cullsAllRays = true; }),
        ofMaterial([](Material& m) { m.clockwise = true; }),
        ofMaterial([](Material& m) { m.fog.mode = FogMode::Linear; }),
        ofMaterial([](Material& m) { m.fog.density = 7.0f; }),
        ofMaterial([](Material& m) { m.fog.radial = true; }),
        ofMaterial([](Material& m) { m.fog.color.x = 0.7f; }),
        ofMaterial([](Material& m) { m.fog.start = 0.7f; }),
        ofMaterial([](Material& m) { m.fog.end = 7.0f; }),
        ofMaterial([](Material& m) { m.baseColorTexture = 0; }),
        ofMaterial([](Material& m) { m.metallicRoughnessTexture = 0; }),
        ofMaterial([](Material& m) { m.transmissionTexture = 0; }),
        ofMaterial([](Material& m) { m.emissionTexture = 0; }),
        ofMaterial([](Material& m) { m.detail.reset(); }),
        ofDetail([](MaterialDetail& d) { d.thinWalled = true; }),
        ofDetail([](MaterialDetail& d) { d.vertexColors = !d.vertexColors; }),
        ofDetail([](MaterialDetail& d) { d.interior.sigmaA.y = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.specular = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.specularColor.y = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.clearcoat = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.clearcoatRoughness = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.clearcoatNormalScale = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.sheenRoughness = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.anisotropy = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.anisotropyRotation = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.diffuseTransmission = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.diffuseTransmissionColor.y = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.subsurface = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.subsurfaceRadius.y = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.iridescence = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.iridescenceIor = 1.7f; }),
        ofDetail([](MaterialDetail& d) { d.normalScale = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.places[kNormalRole].set = 7; }),
        ofDetail([](MaterialDetail& d) { d.places[kNormalRole].u.x = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.places[kNormalRole].v.x = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.interior.sigmaS.x = 7.0f; }),
        ofDetail([](MaterialDetail& d) { d.interior.emission.z = 7.0f; }),
        ofDetail([](MaterialDetail& d) { d.interior.anisotropy = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.interior.dropletSize = 7.0f; }),
        ofDetail([](MaterialDetail& d) { d.interior.priority = 7; }),
        ofDetail([](MaterialDetail& d) { d.sheenColor.y = 0.7f; }),
        ofDetail([](MaterialDetail& d) { d.iridescenceThickness.y = 7.0f; }),
        ofDetail([](MaterialDetail& d) { d.textures[kNormalRole] = 0; }),
        ofDetail([](MaterialDetail& d) { d.places[kNormalRole].offset.y = 0.7f; }),
        ofTexture([](Texture& t) { t.bytes[2] = 7; }),
        ofTexture([](Texture& t) { t.wrapT = TextureWrap::Mirror; }),
        ofTexture([](Texture& t) { t.wrapS = TextureWrap::Mirror; }),
        ofTexture([](Texture& t) { t.wrapR = TextureWrap::Mirror; }),
        ofTexture([](Texture& t) { t.width = 2; }),
        ofTexture([](Texture& t) { t.height = 2; }),
        ofTexture([](Texture& t) { t.depth = 2; }),
        ofTexture([](Texture& t) { t.cube = true; }),
        ofTexture([](Texture& t) { t.hasColor = !t.hasColor; }),
        ofTexture([](Texture& t) { t.hasAlpha = !t.hasAlpha; }),
        ofTexture([](Texture& t) { t.opaque = !t.opaque; }),
        ofTexture([](Texture& t) { t.border.x = 0.7f; }),
        ofTexture([](Texture& t) { t.linearFilter = !t.linearFilter; }),
        ofTexture([](Texture& t) { t.blendsMips = !t.blendsMips; }),
        ofTexture([](Texture& t) { t.floats = {0.7f}; }),
        ofTexture(
            [](Texture& t)
            {
                t.mips.push_back(Texture());
                t.mips[0].linearFilter = !t.mips[0].linearFilter;
            }),
        ofTexture([](Texture& t) { t.decodeSrgb = true; }),
        ofTexture([](Texture& t) { t.mips.push_back(Texture()); }),
        ofLight([](Light& l) { l.kind = LightKind::Environment; }),
        ofLight([](Light& l) { l.number = 7; }),
        ofLight([](Light& l) { l.eyeSpace = true; }),
        ofLight([](Light& l) { l.castsShadows = false; }),
        ofLight([](Light& l) { l.position.z = 7.0f; }),
        ofLight([](Light& l) { l.ambient.z = 7.0f; }),
        ofLight([](Light& l) { l.diffuse.z = 7.0f; }),
        ofLight([](Light& l) { l.specular.z = 7.0f; }),
        ofLight([](Light& l) { l.direction.x = 0.7f; }),
        ofLight([](Light& l) { l.attenuationConstant = 7.0f; }),
        ofLight([](Light& l) { l.attenuationLinear = 7.0f; }),
        ofLight([](Light& l) { l.attenuationQuadratic = 7.0f; }),
        ofLight([](Light& l) { l.spotExponent = 7.0f; }),
        ofLight([](Light& l) { l.radius = 7.0f; }),
        ofLight([](Light& l) { l.corner.z = 7.0f; }),
        ofLight([](Light& l) { l.edgeU.z = 7.0f; }),
        ofLight([](Light& l) { l.instance = 7; }),
        ofLight([](Light& l) { l.range = 7.0f; }),
        ofLight([](Light& l) { l.spotCosCutoff = 0.7f; }),
        ofLight([](Light& l) { l.sine = 0.7f; }),
        ofLight([](Light& l) { l.edgeV.z = 7.0f; }),
        ofLight([](Light& l) { l.radiance.z = 7.0f; }),
        ofLight([](Light& l) { l.twoSided = true; }),
        ofLight([](Light& l) { l.environment.visible = false; }),
        ofLight([](Light& l) { l.environment.mapFromEngine[0][0] = -1.0f; }),
        ofLight([](Light& l) { l.environment.image.reset(); }),
    };
}

} // namespace osgRayTrace::engine::test
