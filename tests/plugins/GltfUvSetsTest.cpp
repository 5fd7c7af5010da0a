// GltfUvSetsTest.cpp - textures are looked up by any UV set, in rays and in OpenGL. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfPictures.h"
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/TexEnv>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Returns a model of a square with textures of every kind of look-up, all by one UV set, and of a
/// wall that its emission lights. The sets below that one would lead elsewhere.
Json modelOf(int set)
{
    Json model = triangleModel();
    Json& attributes = attributesOf(model);
    attributes["POSITION"] =
        addAccessor<float>(model, {-2, -2, 0, 2, -2, 0, -2, 2, 0, 2, 2, 0}, kFloat, "VEC3", 4);
    attributes["NORMAL"] =
        addAccessor<float>(model, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 4);
    for (int i = 0; i < set; ++i)
        attributes["TEXCOORD_" + std::to_string(i)] = addAccessor<float>(
            model, {0.3f, 0.1f, 0.1f, 0.4f, 0.9f, 0.2f, 0.2f, 0.8f}, kFloat, "VEC2", 4);
    attributes["TEXCOORD_" + std::to_string(set)] =
        addAccessor<float>(model, {0, 1, 1, 1, 0, 0, 1, 0}, kFloat, "VEC2", 4);
    Json& square = model["meshes"][0]["primitives"][0];
    square["indices"] =
        addAccessor<std::uint8_t>(model, {0, 1, 2, 2, 1, 3}, kUnsignedByte, "SCALAR", 6);
    square["material"] = 0;
    const int wall = addAccessor<float>(
        model, {-2, -2.1f, 0, -2, -2.1f, 4, 2, -2.1f, 0, 2, -2.1f, 4}, kFloat, "VEC3", 4);
    model["meshes"].push_back(
        {{"primitives",
          Json::array({{{"attributes", {{"POSITION", wall}}}, {"mode", 5}, {"material", 1}}})}});
    model["nodes"].push_back({{"mesh", 1}});
    model["scenes"][0]["nodes"] = {0, 1};
    const auto texture = [set](int index) { return Json{{"index", index}, {"texCoord", set}}; };
    Json base = texture(0);
    base["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.1, 0.2}}, {"rotation", 0.4}, {"scale", {1.5, 2}}, {"texCoord", set}};
    Json normal = texture(1);
    normal["scale"] = 0.7;
    Json material;
    material["pbrMetallicRoughness"] = {{"baseColorTexture", base}, {"roughnessFactor", 0.6}};
    material["normalTexture"] = normal;
    material["emissiveTexture"] = texture(2);
    material["emissiveFactor"] = {1, 1, 1};
    material["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.8},
                                                          {"anisotropyTexture", texture(1)}};
    model["materials"] = {material, {{"doubleSided", true}}};
    model["materials"][1]["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    const auto noise = [](int x, int y) { return static_cast<unsigned char>(x * 53 + y * 91); };
    model["images"] = {
        {{"uri", pngOf(8, [&](int x, int y)
                       { return osg::Vec3ub(noise(x, y), noise(y, x), noise(x + 1, y)); })}},
        {{"uri",
          pngOf(8, [&](int x, int y) { return osg::Vec3ub(100 + noise(x, y) / 4, 128, 220); })}},
        {{"uri", pngOf(8, [&](int x, int) { return osg::Vec3ub(x > 5 ? 255 : 0, 0, 20 * x); })}}};
    model["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
    return model;
}

} // namespace

TEST_CASE("gltf: a picture is the same by whichever UV set its textures are looked up", "[gltf]")
{
    const auto expected = sceneOf(modelOf(0), "noRotation");
    for (const int set : {1, 2, 5, 7})
    {
        INFO(set);
        const Listening listening;
        const auto scene = sceneOf(modelOf(set), "noRotation");
        CHECK(listening.text().empty());
        const auto* material = static_cast<PhysicalMaterial*>(
            geometryOf(*scene).getStateSet()->getAttribute(PhysicalMaterial::ATTRIBUTE_TYPE));
        CHECK(material->getTexturePlace(PhysicalMaterial::NORMAL_TEXTURE).unit ==
              static_cast<unsigned int>(set));
        for (const auto integrator :
             {RayTraceSettings::WHITTED, RayTraceSettings::PATH, RayTraceSettings::SPPM})
        {
            INFO(integrator);
            const Difference difference = differenceOf(*pictureOf(*expected, integrator, true),
                                                       *pictureOf(*scene, integrator, true));
            CHECK(difference.brightest > 0.5f);
            CHECK(difference.largest < 1e-5f * difference.brightest);
        }
    }
    // The other sets would show.
    Json wrong = modelOf(5);
    attributesOf(wrong)["TEXCOORD_5"] = attributesOf(wrong)["TEXCOORD_4"];
    const auto scene = sceneOf(wrong, "noRotation");
    CHECK(differenceOf(*pictureOf(*expected), *pictureOf(*scene)).largest > 0.1f);
}

TEST_CASE("gltf: OpenGL has textures of further UV sets on units that the material leaves",
          "[gltf]")
{
    const auto isOf = [](const osg::Geometry& geometry, unsigned int unit, unsigned int set)
    { return geometry.getTexCoordArray(unit) == geometry.getTexCoordArray(set); };
    const auto modeOf = [](const osg::Geometry& geometry, unsigned int unit)
    {
        const auto* env = dynamic_cast<const osg::TexEnv*>(
            geometry.getStateSet()->getTextureAttribute(unit, osg::StateAttribute::TEXENV));
        return env ? int(env->getMode()) : 0;
    };
    auto scene = sceneOf(modelOf(0));
    const osg::Geometry* geometry = &geometryOf(*scene);
    CHECK(modeOf(*geometry, 0) == osg::TexEnv::MODULATE);
    CHECK(modeOf(*geometry, 1) == osg::TexEnv::ADD);
    CHECK(isOf(*geometry, 1, 0));

    scene = sceneOf(modelOf(1)); // as the unit of its number is there, it has it
    geometry = &geometryOf(*scene);
    CHECK(modeOf(*geometry, 1) == osg::TexEnv::MODULATE);
    CHECK(modeOf(*geometry, 2) == osg::TexEnv::ADD);
    CHECK(isOf(*geometry, 2, 1));

    scene = sceneOf(modelOf(5));
    geometry = &geometryOf(*scene);
    CHECK(modeOf(*geometry, 0) == osg::TexEnv::MODULATE);
    CHECK(modeOf(*geometry, 1) == osg::TexEnv::ADD);
    CHECK(isOf(*geometry, 0, 5));
    CHECK(isOf(*geometry, 1, 5));
    CHECK_FALSE(isOf(*geometry, 2, 5));

    Json mixed = modelOf(1); // what shines must not take the coordinates of the normal map
    for (const char* texture : {"emissiveTexture"})
        mixed["materials"][0][texture]["texCoord"] = 0;
    mixed["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    scene = sceneOf(mixed);
    geometry = &geometryOf(*scene);
    CHECK(modeOf(*geometry, 0) == osg::TexEnv::MODULATE);
    CHECK(modeOf(*geometry, 2) == osg::TexEnv::ADD);
    CHECK(isOf(*geometry, 2, 0));
    CHECK_FALSE(isOf(*geometry, 1, 0));

    Json high = modelOf(0);
    high["materials"][0]["normalTexture"]["texCoord"] = 8;
    CHECK(refusalOf(high).find("set of coordinates above 7") != std::string::npos);
}
