// GltfMaterialTest.cpp - glTF materials, for the rasterizer and for the ray tracer. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/Material>
#include <osg/TexMat>
#include <osg/Texture2D>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// A PNG image of one pixel, red.
const char* const kPixel =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"
    "pLvAAAAAElFTkSuQmCC";

/// Returns the triangle, lit, with a material.
Json modelOf(const std::string& material)
{
    Json model = triangleModel();
    attributesOf(model)["NORMAL"] =
        addAccessor<float>(model, {0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    model["materials"] = Json::array({Json::parse(material)});
    model["meshes"][0]["primitives"][0]["material"] = 0;
    model["images"] = {{{"uri", std::string("data:image/png;base64,") + kPixel}}};
    model["textures"] = Json::parse(R"([{ "source": 0 }, { "source": 0, "sampler": 0 }])");
    model["samplers"] = Json::parse(
        R"([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9985 }])");
    return model;
}

template <typename Attribute>
const Attribute* attributeOf(osg::Geometry& geometry, osg::StateAttribute::Type type)
{
    return dynamic_cast<const Attribute*>(geometry.getStateSet()->getAttribute(type));
}

const PhysicalMaterial* physicalOf(osg::Geometry& geometry)
{
    return attributeOf<PhysicalMaterial>(geometry, PhysicalMaterial::ATTRIBUTE_TYPE);
}

const osg::Material* classicOf(osg::Geometry& geometry)
{
    return attributeOf<osg::Material>(geometry, osg::StateAttribute::MATERIAL);
}

} // namespace

TEST_CASE("gltf: factors are linear in the PhysicalMaterial, and sRGB for OpenGL", "[gltf]")
{
    const auto scene = sceneOf(modelOf(R"({ "name": "paint",
        "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0, 1, 0.25], "metallicFactor": 0.25,
                                  "roughnessFactor": 0.75 },
        "emissiveFactor": [0.5, 1, 0],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 8 },
                        "KHR_materials_ior": { "ior": 1.75 } } })"));
    osg::Geometry& geometry = geometryOf(*scene);
    const PhysicalMaterial& physical = *physicalOf(geometry);
    CHECK(physical.getName() == "paint");
    CHECK(physical.getBaseColor() == osg::Vec3(0.5f, 0, 1));
    CHECK(physical.getMetallic() == 0.25f);
    CHECK(physical.getRoughness() == 0.75f);
    CHECK(physical.getEmission() == osg::Vec3(4, 8, 0));
    CHECK(physical.getIor() == 1.75f);
    CHECK(physical.getAlpha() == 1.0f); // OPAQUE
    const osg::Vec4 diffuse = classicOf(geometry)->getDiffuse(osg::Material::FRONT);
    CHECK(diffuse.r() == Approx(0.73536f).margin(1e-4));
    CHECK(diffuse.a() == 1.0f);
}

TEST_CASE("gltf: a primitive without material has glTF's default", "[gltf]")
{
    const auto scene = sceneOf(triangleModel());
    const PhysicalMaterial& physical = *physicalOf(geometryOf(*scene));
    CHECK(physical.getBaseColor() == osg::Vec3(1, 1, 1));
    CHECK(physical.getMetallic() == 1.0f);
    CHECK(physical.getRoughness() == 1.0f);
    CHECK(geometryOf(*scene).getStateSet()->getMode(GL_CULL_FACE) == osg::StateAttribute::ON);
}

TEST_CASE("gltf: alpha modes", "[gltf]")
{
    const std::string half = R"("pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.5] })";
    auto scene = sceneOf(modelOf("{" + half + R"(, "alphaMode": "MASK", "alphaCutoff": 0.25 })"));
    osg::Geometry* geometry = &geometryOf(*scene);
    const auto* test = attributeOf<osg::AlphaFunc>(*geometry, osg::StateAttribute::ALPHAFUNC);
    REQUIRE(test);
    CHECK(test->getFunction() == osg::AlphaFunc::GEQUAL);
    CHECK(test->getReferenceValue() == 0.25f);
    CHECK(geometry->getStateSet()->getMode(GL_BLEND) == osg::StateAttribute::INHERIT);
    CHECK(physicalOf(*geometry)->getAlpha() == 0.5f);

    scene = sceneOf(modelOf("{" + half + R"(, "alphaMode": "BLEND", "doubleSided": true })"));
    geometry = &geometryOf(*scene);
    CHECK(attributeOf<osg::BlendFunc>(*geometry, osg::StateAttribute::BLENDFUNC));
    CHECK(geometry->getStateSet()->getMode(GL_BLEND) == osg::StateAttribute::ON);
    CHECK(geometry->getStateSet()->getRenderingHint() == osg::StateSet::TRANSPARENT_BIN);
    CHECK(geometry->getStateSet()->getMode(GL_CULL_FACE) == osg::StateAttribute::OFF);
    CHECK(classicOf(*geometry)->getDiffuse(osg::Material::FRONT).a() == 0.5f);
    CHECK(refusalOf(modelOf(R"({ "alphaMode": "ADD" })")).find("materials[0].alphaMode") !=
          std::string::npos);
}

TEST_CASE("gltf: textures with sampler, UV set and transform", "[gltf]")
{
    Json model = modelOf(R"({ "pbrMetallicRoughness": {
        "baseColorTexture": { "index": 1, "texCoord": 1, "extensions": { "KHR_texture_transform":
            { "offset": [0.25, 0.125], "rotation": 0.5, "scale": [2, 4] } } },
        "metallicRoughnessTexture": { "index": 0 } }, "normalTexture": { "index": 0, "scale": 2 } })");
    const std::vector<float> uv{0, 0, 0.75f, 0.25f, 0, 1};
    for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"})
        attributesOf(model)[set] = addAccessor<float>(model, uv, kFloat, "VEC2", 3);
    const auto scene = sceneOf(model);
    osg::Geometry& geometry = geometryOf(*scene);
    const osg::StateSet& states = *geometry.getStateSet();
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        states.getTextureAttribute(1, osg::StateAttribute::TEXTURE));
    REQUIRE(texture);
    CHECK(texture->getWrap(osg::Texture::WRAP_S) == osg::Texture::CLAMP_TO_EDGE);
    CHECK(texture->getWrap(osg::Texture::WRAP_T) == osg::Texture::MIRROR);
    CHECK(texture->getFilter(osg::Texture::MAG_FILTER) == osg::Texture::NEAREST);
    CHECK(texture->getFilter(osg::Texture::MIN_FILTER) == osg::Texture::LINEAR_MIPMAP_NEAREST);
    REQUIRE(texture->getImage());
    CHECK(texture->getImage()->getColor(0u, 0u) == osg::Vec4(1, 0, 0, 1));

    // The matrix takes OSG's coordinates to where glTF looks: v down, scaled, turned, moved.
    const auto* matrix = dynamic_cast<const osg::TexMat*>(
        states.getTextureAttribute(1, osg::StateAttribute::TEXMAT));
    REQUIRE(matrix);
    const osg::Vec2 own = arrayOf<osg::Vec2Array>(geometry.getTexCoordArray(1))[1];
    CHECK(own == osg::Vec2(0.75f, 0.75f));
    const osg::Vec3d moved = osg::Vec3d(own.x(), own.y(), 0) * matrix->getMatrix();
    const double c = std::cos(0.5), s = std::sin(0.5), u = 2 * 0.75, v = 4 * 0.25;
    CHECK(moved.x() == Approx(0.25 + c * u + s * v));
    CHECK(1.0 - moved.y() == Approx(0.125 - s * u + c * v));

    const PhysicalMaterial& physical = *physicalOf(geometry);
    CHECK(physical.getTexture(PhysicalMaterial::BASE_COLOR_TEXTURE) == texture);
    const auto& place = physical.getTexturePlace(PhysicalMaterial::BASE_COLOR_TEXTURE);
    CHECK(place.unit == 1);
    const double a = place.scale.x() * own.x(), b = place.scale.y() * own.y();
    CHECK(place.offset.x() + std::cos(place.rotation) * a - std::sin(place.rotation) * b ==
          Approx(moved.x()));
    CHECK(place.offset.y() + std::sin(place.rotation) * a + std::cos(place.rotation) * b ==
          Approx(moved.y()));
    CHECK(physical.getTexture(PhysicalMaterial::NORMAL_TEXTURE));
    CHECK(physical.getNormalScale() == 2.0f);
}

TEST_CASE("gltf: unlit surfaces have colours, and no PhysicalMaterial", "[gltf]")
{
    Json model = modelOf(R"({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 1, 1, 1] },
                              "extensions": { "KHR_materials_unlit": {} } })");
    auto scene = sceneOf(model);
    osg::Geometry* geometry = &geometryOf(*scene);
    CHECK_FALSE(physicalOf(*geometry));
    CHECK(geometry->getStateSet()->getMode(GL_LIGHTING) == osg::StateAttribute::OFF);
    const auto& one = arrayOf<osg::Vec4Array>(geometry->getColorArray());
    REQUIRE(one.size() == 1);
    CHECK(one[0].r() == Approx(0.73536f).margin(1e-4));

    attributesOf(model)["COLOR_0"] = addAccessor<std::uint8_t>(
        model, {255, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 51}, kUnsignedByte, "VEC4", 3);
    model["accessors"].back()["normalized"] = true;
    scene = sceneOf(model);
    const auto& colors = arrayOf<osg::Vec4Array>(geometryOf(*scene).getColorArray());
    CHECK(colors[0].r() == Approx(0.73536f).margin(1e-3));
    CHECK(colors[2].g() == Approx(1.0f));
}

TEST_CASE("gltf: vertex colours are linear in the file and sRGB in OSG", "[gltf]")
{
    Json model = modelOf("{}");
    attributesOf(model)["COLOR_0"] =
        addAccessor<float>(model, {0.5f, 0, 1, 1, 1, 1, 0, 0, 0}, kFloat, "VEC3", 3);
    const auto scene = sceneOf(model);
    osg::Geometry& geometry = geometryOf(*scene);
    const auto& colors = arrayOf<osg::Vec4Array>(geometry.getColorArray());
    CHECK(colors[0].r() == Approx(0.73536f).margin(1e-4));
    CHECK(colors[0].a() == 1.0f);
    CHECK(physicalOf(geometry)->getVertexColors());
    CHECK(classicOf(geometry)->getColorMode() == osg::Material::AMBIENT_AND_DIFFUSE);
}

TEST_CASE("gltf: layers and volumes are the PhysicalMaterial's", "[gltf]")
{
    const auto scene = sceneOf(modelOf(R"({ "extensions": {
        "KHR_materials_transmission": { "transmissionFactor": 0.5 },
        "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": 3,
                                  "attenuationColor": [1, 0.5, 0.25] },
        "KHR_materials_specular": { "specularFactor": 0.25, "specularColorFactor": [2, 1, 0] },
        "KHR_materials_clearcoat": { "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.125,
            "clearcoatNormalTexture": { "index": 0, "scale": 0.75 } },
        "KHR_materials_sheen": { "sheenColorFactor": [0, 1, 0], "sheenRoughnessFactor": 0.5 } } })"));
    const PhysicalMaterial& physical = *physicalOf(geometryOf(*scene));
    CHECK(physical.getTransmission() == 0.5f);
    CHECK_FALSE(physical.getThinWalled());
    CHECK(physical.getAttenuationDistance() == 3.0f);
    CHECK(physical.getAttenuationColor() == osg::Vec3(1, 0.5f, 0.25f));
    CHECK(physical.getSpecular() == 0.25f);
    CHECK(physical.getSpecularColor() == osg::Vec3(2, 1, 0));
    CHECK(physical.getClearcoat() == 0.5f);
    CHECK(physical.getClearcoatRoughness() == 0.125f);
    CHECK(physical.getClearcoatNormalScale() == 0.75f);
    CHECK(physical.getTexture(PhysicalMaterial::CLEARCOAT_NORMAL_TEXTURE));
    CHECK_FALSE(physical.getTexture(PhysicalMaterial::NORMAL_TEXTURE));
    CHECK(physical.getSheenColor() == osg::Vec3(0, 1, 0));
    CHECK(physical.getSheenRoughness() == 0.5f);
    const auto thin = sceneOf(modelOf(
        R"({ "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } } })"));
    CHECK(physicalOf(geometryOf(*thin))->getThinWalled());
    // Rays inside of glass meet its back faces.
    CHECK(geometryOf(*thin).getStateSet()->getMode(GL_CULL_FACE) == osg::StateAttribute::OFF);
}

TEST_CASE("gltf: anisotropy, diffuse transmission and iridescence", "[gltf]")
{
    Json model = modelOf(R"({ "extensions": {
        "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyRotation": 1.25,
                                      "anisotropyTexture": { "index": 0 } },
        "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 0.25,
            "diffuseTransmissionColorFactor": [1, 0.5, 0],
            "diffuseTransmissionTexture": { "index": 0 },
            "diffuseTransmissionColorTexture": { "index": 0 } },
        "KHR_materials_iridescence": { "iridescenceFactor": 0.75, "iridescenceIor": 1.5,
            "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 600,
            "iridescenceTexture": { "index": 0 },
            "iridescenceThicknessTexture": { "index": 0 } } } })");
    const auto scene = sceneOf(model);
    const PhysicalMaterial& physical = *physicalOf(geometryOf(*scene));
    CHECK(physical.getAnisotropy() == 0.5f);
    CHECK(physical.getAnisotropyRotation() == 1.25f);
    CHECK(physical.getDiffuseTransmission() == 0.25f);
    CHECK(physical.getDiffuseTransmissionColor() == osg::Vec3(1, 0.5f, 0));
    CHECK(physical.getIridescence() == 0.75f);
    CHECK(physical.getIridescenceIor() == 1.5f);
    CHECK(physical.getIridescenceThicknessMinimum() == 200.0f);
    CHECK(physical.getIridescenceThicknessMaximum() == 600.0f);
    for (int i = PhysicalMaterial::ANISOTROPY_TEXTURE;
         i <= PhysicalMaterial::IRIDESCENCE_THICKNESS_TEXTURE; ++i)
        CHECK(physical.getTexture(static_cast<PhysicalMaterial::TextureUse>(i)));
    const auto plain = sceneOf(modelOf(R"({ "extensions": { "KHR_materials_anisotropy": {},
        "KHR_materials_diffuse_transmission": {}, "KHR_materials_iridescence": {} } })"));
    const PhysicalMaterial& defaults = *physicalOf(geometryOf(*plain));
    CHECK(defaults.getAnisotropy() == 0.0f);
    CHECK(defaults.getDiffuseTransmission() == 0.0f);
    CHECK(defaults.getIridescence() == 0.0f);
    CHECK(defaults.getIridescenceIor() == 1.3f);
    CHECK(defaults.getIridescenceThicknessMaximum() == 400.0f);
}

TEST_CASE("gltf: the old workflow of specular colour and glossiness", "[gltf]")
{
    const auto scene = sceneOf(modelOf(R"({ "extensions": { "KHR_materials_pbrSpecularGlossiness":
        { "diffuseFactor": [0.5, 0.25, 0, 1], "specularFactor": [0.04, 0.08, 0.5],
          "glossinessFactor": 0.75 } } })"));
    const PhysicalMaterial& physical = *physicalOf(geometryOf(*scene));
    CHECK(physical.getMetallic() == 0.0f);
    CHECK(physical.getRoughness() == 0.25f);
    CHECK(physical.getBaseColor() == osg::Vec3(0.5f, 0.25f, 0));
    CHECK(physical.getSpecularColor().x() == Approx(1.0f));
    CHECK(physical.getSpecularColor().z() == Approx(12.5f));
}

TEST_CASE("gltf: the alpha of a specular colour is a glossiness", "[gltf]")
{
    Json model = modelOf(R"({ "extensions": { "KHR_materials_pbrSpecularGlossiness":
        { "glossinessFactor": 0.5, "specularGlossinessTexture": { "index": 1 } } } })");
    // One pixel of 10, 20, 30 and the alpha 51.
    model["images"][0]["uri"] =
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGPg"
        "EpEzBgAA2ABwyFBEOAAAAABJRU5ErkJggg==";
    const auto scene = sceneOf(model);
    const PhysicalMaterial& physical = *physicalOf(geometryOf(*scene));
    const osg::Texture2D* roughness =
        physical.getTexture(PhysicalMaterial::METALLIC_ROUGHNESS_TEXTURE);
    REQUIRE(roughness);
    CHECK(physical.getRoughness() == 1.0f);
    CHECK(roughness->getImage()->getColor(0u, 0u).g() == Approx(1 - 0.5 * 0.2).margin(0.003));
    CHECK(roughness->getWrap(osg::Texture::WRAP_S) == osg::Texture::CLAMP_TO_EDGE);
    CHECK(physical.getTexture(PhysicalMaterial::SPECULAR_COLOR_TEXTURE));
}

TEST_CASE("gltf: a variant has its own materials", "[gltf]")
{
    Json model = modelOf(R"({ "name": "plain" })");
    model["materials"].push_back({{"name", "red"}});
    model["extensions"]["KHR_materials_variants"] = Json::parse(R"({ "variants": [{ "name": "a" },
                                                                                  { "name": "b" }] })");
    model["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] =
        Json::parse(R"({ "mappings": [{ "material": 1, "variants": [1] }] })");
    const auto nameOf = [&model](const std::string& options)
    { return physicalOf(geometryOf(*sceneOf(model, options)))->getName(); };
    CHECK(nameOf("") == "plain");
    CHECK(nameOf("variant=a") == "plain");
    CHECK(nameOf("variant=b") == "red");
    CHECK(nameOf("variant=1") == "red"); // names may have spaces, which options do not
    const Listening listening;
    CHECK(nameOf("variant=c") == "plain");
    CHECK(listening.text().find("has 2 variants, and none is 'c'") != std::string::npos);
}

TEST_CASE("gltf: an image that cannot be read is reported, and the model is there", "[gltf]")
{
    Json model = modelOf(R"({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } })");
    for (const char* bytes : {"nonsense", "\x89PNG and no more", "\xff\xd8\xff\xe0"})
    {
        model["images"][0]["uri"] = "data:image/png;base64," + base64(bytes);
        const Listening listening;
        CHECK(refusalOf(model).empty());
        CHECK(listening.text().find("images[0]") != std::string::npos);
    }
    const std::string huge = std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) +
                             std::string("\0\1\0\0\0\1\0\0", 8) + std::string(40, '\0');
    model["images"][0]["uri"] = "data:image/png;base64," + base64(huge);
    const Listening listening;
    CHECK(refusalOf(model).empty());
    CHECK(listening.text().find("2^26 pixels") != std::string::npos);
}
