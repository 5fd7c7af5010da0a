// GltfMorphTest.cpp - tangents and flat normals follow morph targets. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfPictures.h"
#include "tests/Catch.h"

#include <osgAnimation/MorphGeometry>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

using Values = std::vector<float>;

/// A square with tangents, as it is and as it is turned, bent and with its tangents turned on it:
/// nobody could make these of the other arrays.
struct Square
{
    Values positions, normals, tangents; ///< tangents: three a vertex
};

Square squareOf(float angle)
{
    const osg::Quat turn(angle, osg::Vec3(0.6f, 0.8f, 0.0f));
    const osg::Quat twist(0.5 + angle, osg::Vec3(0.0f, 0.0f, 1.0f));
    Square square;
    const auto add = [](Values& values, const osg::Vec3& v)
    { values.insert(values.end(), v.ptr(), v.ptr() + 3); };
    for (const osg::Vec3& corner :
         {osg::Vec3(-2, -2, 0), osg::Vec3(2, -2, 0), osg::Vec3(-2, 2, 0), osg::Vec3(2, 2, 0)})
    {
        add(square.positions, turn * corner);
        add(square.normals, turn * osg::Vec3(0, 0, 1));
        add(square.tangents, turn * (twist * osg::Vec3(1, 0, 0)));
    }
    return square;
}

int addVectors(Json& model, const Values& values)
{
    return addAccessor<float>(model, values, kFloat, "VEC3", values.size() / 3);
}

/// Returns a model of a square with a normal map.
Json modelOf(const Square& square)
{
    Json model = triangleModel();
    Json& attributes = attributesOf(model);
    attributes["POSITION"] = addVectors(model, square.positions);
    attributes["NORMAL"] = addVectors(model, square.normals);
    Values tangents;
    for (std::size_t i = 0; i < square.tangents.size(); i += 3)
        tangents.insert(tangents.end(),
                        {square.tangents[i], square.tangents[i + 1], square.tangents[i + 2], 1.0f});
    attributes["TANGENT"] = addAccessor<float>(model, tangents, kFloat, "VEC4", 4);
    attributes["TEXCOORD_0"] =
        addAccessor<float>(model, {0, 1, 1, 1, 0, 0, 1, 0}, kFloat, "VEC2", 4);
    Json& primitive = model["meshes"][0]["primitives"][0];
    primitive["indices"] =
        addAccessor<std::uint8_t>(model, {0, 1, 2, 2, 1, 3}, kUnsignedByte, "SCALAR", 6);
    primitive["material"] = 0;
    model["materials"] = Json::parse(R"([{ "normalTexture": { "index": 0 }, "doubleSided": true,
        "pbrMetallicRoughness": { "metallicFactor": 0.5, "roughnessFactor": 0.5 } }])");
    model["images"] = {{{"uri", pngOf(1, [](int, int) { return osg::Vec3ub(215, 110, 210); })}}};
    model["textures"] = {{{"source", 0}}};
    return model;
}

Values difference(const Values& a, const Values& b)
{
    Values result;
    for (std::size_t i = 0; i < a.size(); ++i)
        result.push_back(a[i] - b[i]);
    return result;
}

/// Returns the square of the first angle with a target that makes it that of the second one.
Json morphedModel(float from, float to)
{
    const Square rest = squareOf(from), moved = squareOf(to);
    Json model = modelOf(rest);
    model["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", addVectors(model, difference(moved.positions, rest.positions))},
         {"NORMAL", addVectors(model, difference(moved.normals, rest.normals))},
         {"TANGENT", addVectors(model, difference(moved.tangents, rest.tangents))}}};
    return model;
}

Json& targetOf(Json& model)
{
    return model["meshes"][0]["primitives"][0]["targets"][0];
}

void setWeight(osg::Node& scene, float weight)
{
    auto& morph = dynamic_cast<osgAnimation::MorphGeometry&>(geometryOf(scene));
    morph.setWeight(0, weight);
    morph.transformSoftwareMethod();
}

} // namespace

TEST_CASE("gltf: tangents of targets are added, at rest and while the mesh moves", "[gltf]")
{
    const osg::ref_ptr<osg::Image> rest = pictureOf(*sceneOf(modelOf(squareOf(0.1f)), "noRotation"),
                                                    RayTraceSettings::WHITTED, true),
                                   moved =
                                       pictureOf(*sceneOf(modelOf(squareOf(0.6f)), "noRotation"),
                                                 RayTraceSettings::WHITTED, true);
    const auto isLike = [](osg::Node& scene, const osg::Image& expected)
    {
        const Difference difference =
            differenceOf(expected, *pictureOf(scene, RayTraceSettings::WHITTED, true));
        INFO(difference.largest << " of " << difference.brightest);
        return difference.brightest > 0.1f && difference.largest < 1e-3f * difference.brightest;
    };
    REQUIRE(differenceOf(*rest, *moved).largest > 0.02f);

    Json model = morphedModel(0.1f, 0.6f);
    const Listening listening;
    auto scene = sceneOf(model, "noRotation");
    CHECK(isLike(*scene, *rest));
    model["meshes"][0]["weights"] = {1};
    scene = sceneOf(model, "noRotation");
    CHECK(isLike(*scene, *moved));
    CHECK(listening.text().empty());

    // A scene that was rendered before deforms.
    const osg::ref_ptr<Renderer> renderer = new Renderer;
    setWeight(*scene, 0.0f);
    renderer->setScene(scene.get());
    renderer->setSize(24, 24);
    renderer->setViewMatrix(
        osg::Matrix::lookAt(osg::Vec3d(0.0, 0.0, 8.0), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0)));
    renderer->setProjectionMatrix(osg::Matrix::perspective(40.0, 1.0, 1.0, 100.0));
    renderer->getSettings()->setMaxPasses(4);
    renderer->getSettings()->setIntegrator(RayTraceSettings::WHITTED);
    for (const float weight : {0.0f, 1.0f, 0.5f, 1.0f})
    {
        setWeight(*scene, weight);
        renderer->dirtyScene();
        REQUIRE(renderer->render());
        if (weight == 0.5f) continue;
        const Difference difference =
            differenceOf(weight == 0.0f ? *rest : *moved, *renderer->getColorImage());
        INFO(weight << ": " << difference.largest);
        CHECK(difference.largest < 1e-3f * difference.brightest);
    }
}

TEST_CASE("gltf: tangents of targets are read and spoken of only where rays follow them", "[gltf]")
{
    const auto tangentsOf = [](osg::Node& scene)
    {
        auto& morph = dynamic_cast<osgAnimation::MorphGeometry&>(geometryOf(scene));
        const osg::Geometry& target = *morph.getMorphTarget(0).getGeometry();
        return target.getNumVertexAttribArrays() > 6 ? target.getVertexAttribArray(6) : nullptr;
    };
    const auto linesOf = [](const Json& model)
    {
        const Listening listening;
        sceneOf(model);
        return listening.text();
    };
    Json model = morphedModel(0.1f, 0.6f);
    CHECK(tangentsOf(*sceneOf(model)));
    CHECK(linesOf(model).empty());
    Json bare = model;
    attributesOf(bare).erase("TANGENT");
    CHECK(linesOf(bare).find("primitives[0]: has tangents of targets, but none of its own") !=
          std::string::npos);
    CHECK_FALSE(tangentsOf(*sceneOf(bare)));
    bare["materials"][0].erase("normalTexture");
    CHECK(linesOf(bare).empty());
    bare["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyStrength"] = 0.5;
    CHECK(linesOf(bare).find("tangents of targets") != std::string::npos);
    attributesOf(bare).erase("NORMAL"); // glTF: such tangents are to be ignored
    CHECK(linesOf(bare).empty());
    Json plain = model;
    plain["materials"][0].erase("normalTexture");
    CHECK_FALSE(tangentsOf(*sceneOf(plain)));
    Json wrong = model;
    targetOf(wrong)["TANGENT"] = addVectors(wrong, {1, 2, 3});
    CHECK(refusalOf(wrong).find("has 1 elements of a target's TANGENT for 4 vertices") !=
          std::string::npos);
}

TEST_CASE("gltf: targets of a mesh without normals have flat ones", "[gltf]")
{
    Json model = morphedModel(0.0f, 0.6f);
    attributesOf(model).erase("NORMAL");
    targetOf(model).erase("NORMAL");
    model["meshes"][0]["weights"] = {1};
    const auto scene = sceneOf(model, "noRotation");
    const auto& normals = arrayOf<osg::Vec3Array>(geometryOf(*scene).getNormalArray());
    const Square moved = squareOf(0.6f);
    const osg::Vec3 expected(moved.normals[0], moved.normals[1], moved.normals[2]);
    REQUIRE(normals.size() == 6);
    for (const osg::Vec3& normal : normals)
        CHECK((normal - expected).length() < 1e-5f);
}
