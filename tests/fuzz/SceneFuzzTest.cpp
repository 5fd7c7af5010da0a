// SceneFuzzTest.cpp - random scene graphs converted, built and rendered. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GeometryGenerator.h"
#include "GraphGenerator.h"
#include "tests/Catch.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/geometry/GeometryConverter.h"
#include "osgRayTrace/session/RenderSession.h"

#include <osg/Notify>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <string>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 16;
constexpr int kGeometries = 10000, kGraphs = 10000; ///< seeds

/// Returns an empty string, or what is wrong with a mesh that Embree and the integrators will
/// trust.
std::string faultOf(const Mesh& mesh)
{
    const std::size_t count = mesh.positions.size();
    for (const UVec3& t : mesh.triangles)
    {
        if (t.x >= count || t.y >= count || t.z >= count) return "an index is out of range";
        for (const uint32_t i : {t.x, t.y, t.z})
        {
            const Vec3& p = mesh.positions[i];
            if (!(std::fabs(p.x) <= 1e18f && std::fabs(p.y) <= 1e18f && std::fabs(p.z) <= 1e18f))
                return "a corner is not finite or too far";
            if (!mesh.normals.empty() &&
                !(std::fabs(glm::dot(mesh.normals[i], mesh.normals[i]) - 1.0f) < 1e-2f))
                return "a normal is not of unit length";
            if (!mesh.uvs.empty() &&
                !(std::isfinite(mesh.uvs[i].x) && std::isfinite(mesh.uvs[i].y)))
                return "a texture coordinate is not finite";
            if (!mesh.colors.empty() &&
                !(isFinite(Vec3(mesh.colors[i])) && std::isfinite(mesh.colors[i].w)))
                return "a colour is not finite";
        }
    }
    for (const std::size_t size : {mesh.normals.size(), mesh.uvs.size(), mesh.colors.size()})
        if (size != 0 && size != count) return "an attribute has another size than the positions";
    return "";
}

uint64_t countIn(const ConversionCounts& counts, const std::string& what)
{
    const auto found = counts.find(what);
    return found == counts.end() ? 0 : found->second;
}

/// Checks the mesh cut by planes, and the mesh with a restart index, which must not have more
/// triangles.
void requireSoundVariants(const osg::Geometry& geometry, const ConvertedMesh& whole)
{
    MeshRequest cut;
    cut.clipPlanes = {Vec4d(1.0, 0.3, -0.2, 0.1), Vec4d(-0.4, 1.0, 0.6, 0.5)};
    const ConvertedMesh clipped = convertGeometry(geometry, cut);
    if (!whole.mesh) REQUIRE(!clipped.mesh);
    if (whole.mesh && !clipped.mesh)
        REQUIRE(countIn(clipped.counts, "not-traced.clipped-away") == 1);
    if (clipped.mesh)
    {
        REQUIRE(faultOf(*clipped.mesh) == "");
        for (const UVec3& t : clipped.mesh->triangles)
            REQUIRE((t.x != t.y && t.y != t.z && t.z != t.x));
    }

    MeshRequest restarted;
    restarted.restart.on = true;
    restarted.restart.index = 2;
    const ConvertedMesh runs = convertGeometry(geometry, restarted);
    if (!runs.mesh) return;
    REQUIRE(faultOf(*runs.mesh) == "");
    REQUIRE(runs.mesh->triangles.size() <= trianglesOfSets(geometry));
}

/// Checks a geometry that is not refused as a whole: each triangle of its primitive sets is in the
/// mesh or counted.
void requireAllTrianglesCounted(const osg::Geometry& geometry)
{
    const ConvertedMesh converted = convertGeometry(geometry, MeshRequest());
    const ConversionCounts& counts = converted.counts;
    requireSoundVariants(geometry, converted);
    for (const char* whole :
         {"skipped.deprecated-data", "not-traced.no-vertices", "skipped.vertex-type"})
        if (countIn(counts, whole)) return;
    if (converted.mesh) REQUIRE(faultOf(*converted.mesh) == "");
    const uint64_t kept = converted.mesh ? converted.mesh->triangles.size() : 0;
    REQUIRE(kept + countIn(counts, "skipped.index-out-of-range") +
                countIn(counts, "skipped.not-finite") + countIn(counts, "skipped.degenerate") ==
            trianglesOfSets(geometry));
}

void requireSound(const Light& light)
{
    if (light.kind != LightKind::Environment) return;
    const EnvironmentImage* image = light.environment.image.get();
    REQUIRE(image);
    REQUIRE(image->radiance.size() == std::size_t(image->width) * std::size_t(image->height));
    for (const Vec3& p : image->radiance)
    {
        const Vec3 placed = p * light.radiance;
        REQUIRE((p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f));
        REQUIRE((isFinite(p) && isFinite(placed)));
    }
    const Mat3 axes =
        light.environment.mapFromEngine * glm::transpose(light.environment.mapFromEngine);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            REQUIRE(std::fabs(axes[i][k] - (i == k ? 1.0f : 0.0f)) < 1e-4f);
}

void requireSound(const ConversionResult& result)
{
    const Scene& scene = *result.scene;
    REQUIRE(countIn(result.counts, "converted.instance") == scene.instances.size());
    REQUIRE(countIn(result.counts, "converted.light") +
                countIn(result.counts, "converted.headlight") ==
            scene.lights.size());
    for (const auto& mesh : scene.meshes)
        REQUIRE(faultOf(*mesh) == "");
    for (const Instance& instance : scene.instances)
    {
        REQUIRE(instance.mesh < scene.meshes.size());
        REQUIRE(instance.material < scene.materials.size());
        if (instance.light != kInvalid) REQUIRE(instance.light < scene.lights.size());
    }
    for (const Light& light : scene.lights)
        requireSound(light);
    for (const auto& texture : scene.textures)
    {
        const std::size_t values = 4 * std::size_t(texture->width) * std::size_t(texture->height);
        REQUIRE(std::max(texture->bytes.size(), texture->floats.size()) == values);
        for (const float value : texture->floats)
            REQUIRE(std::isfinite(value));
    }
}

View viewOfOrigin()
{
    View view;
    view.width = view.height = kSize;
    view.clipFromView = glm::perspective(0.8, 1.0, 0.1, 100.0);
    view.viewFromWorld = glm::lookAt(Vec3d(2.0, 1.5, 5.0), Vec3d(0.0), Vec3d(0.0, 1.0, 0.0));
    return view;
}

/// Returns a view that in most cases looks at the origin.
ReferenceView randomView(Dice& dice, const osg::Vec3d& eye)
{
    ReferenceView view;
    view.viewFromWorld = osg::Matrixd::lookAt(eye, osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0));
    view.projection = osg::Matrixd::perspective(40.0, 1.0, 0.1, 100.0);
    view.width = view.height = dice.oneIn(9) ? 0.0 : kSize;
    view.lodScale = dice.oneIn(9) ? 0.0f : 1.0f;
    if (dice.oneIn(9)) view.viewFromWorld(dice.below(4), dice.below(4)) = dice.strange(1.0, 2);
    if (dice.oneIn(9)) view.projection(dice.below(4), dice.below(4)) = dice.strange(1.0, 2);
    return view;
}

/// Returns whether anything is visible.
bool requireFinitePass(const std::shared_ptr<const TracedScene>& traced,
                       const std::shared_ptr<Workers>& workers, IntegratorKind kind,
                       EnvironmentSampling sampling)
{
    RenderSession session(workers);
    session.setScene(traced);
    session.setView(viewOfOrigin());
    RenderOptions options;
    options.integrator = kind;
    options.maxBounces = 4;
    options.environmentSampling = sampling;
    options.environmentSamples = 20;
    session.setOptions(options);
    StopRule rule;
    rule.passes = 1;
    const RenderProgress progress = session.render(rule);
    CAPTURE(int(kind), progress.status.message);
    REQUIRE(progress.status.ok());
    REQUIRE(progress.rays.camera == kSize * kSize);
    const std::vector<float> image = session.resolveRadiance();
    REQUIRE(image.size() == 4 * kSize * kSize);
    bool finite = true;
    for (const float value : image)
        finite &= std::isfinite(value);
    REQUIRE(finite);

    std::vector<uint8_t> shown(4 * kSize * kSize);
    std::vector<float> depth(kSize * kSize);
    session.resolveDisplay(ToneMap(), shown.data(), depth.data());
    bool inRange = true;
    for (const float value : depth)
        inRange &= value >= 0.0f && value <= 1.0f;
    REQUIRE(inRange);
    return *std::min_element(depth.begin(), depth.end()) < 1.0f;
}

} // namespace

TEST_CASE("fuzz: any geometry is converted, each triangle kept or counted", "[fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    uint64_t kept = 0;
    forEachSeed(kGeometries,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    const osg::ref_ptr<osg::Geometry> geometry = randomGeometry(dice);
                    requireAllTrianglesCounted(*geometry);
                    const ConvertedMesh converted = convertGeometry(*geometry, MeshRequest());
                    kept += converted.mesh != nullptr;
                });
    // The generator is of no use if all geometries are refused.
    CHECK(kept > static_cast<uint64_t>(seedCount(kGeometries)) / 4);
}

// This test does not render, so that it can run the same number of graphs under sanitizers.
TEST_CASE("fuzz: ten thousand scene graphs are converted for changing views", "[fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    uint64_t traced = 0, cut = 0, posed = 0, skies = 0, noSkies = 0;
    forEachSeed(10000 * sanitizerShare(),
                [&](uint32_t seed)
                {
                    Dice dice(seed + 1000000);
                    const RandomGraph graph = randomGraph(dice);
                    SceneConverter converter;
                    for (int i = 0; i < 2; ++i)
                    {
                        ConversionInput input;
                        input.root = graph.root.get();
                        input.eye = osg::Vec3d(2.0 - 5.0 * i, 1.5, 5.0);
                        if (dice.oneIn(3)) input.origin = input.eye;
                        input.rasterizesRest = graph.bounded && dice.oneIn(2);
                        if (dice.oneIn(2)) input.view = randomView(dice, input.eye);
                        const ConversionResult result = converter.convert(input);
                        requireSound(result);
                        traced += !result.scene->instances.empty();
                        cut += countIn(result.counts, "not-traced.clipped-away");
                        posed += countIn(result.counts, "approximated.hardware-pose");
                        skies += countIn(result.counts, "converted.environment-light");
                        noSkies += countIn(result.counts, "skipped.environment-light");
                    }
                });
    const auto count = static_cast<uint64_t>(seedCount(10000 * sanitizerShare()));
    CHECK(traced > count / 2);
    CHECK(cut > count / 50);    // clip planes cut some geometries
    CHECK(posed > count / 100); // some poses must be refused
    CHECK(skies > count / 20);
    CHECK(noSkies > count / 50);
}

TEST_CASE("fuzz: any scene graph is converted, built and rendered, and stays finite", "[fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    const auto workers = std::make_shared<Workers>(2);
    uint64_t seen = 0;
    constexpr EnvironmentSampling kSamplings[] = {EnvironmentSampling::Importance,
                                                  EnvironmentSampling::Structured,
                                                  EnvironmentSampling::Uniform};
    forEachSeed(
        kGraphs,
        [&](uint32_t seed)
        {
            Dice dice(seed);
            const RandomGraph graph = randomGraph(dice);
            ConversionInput input;
            input.root = graph.root.get();
            input.eye = osg::Vec3d(2.0, 1.5, 5.0);
            if (dice.oneIn(3)) input.origin = input.eye;
            input.rasterizesRest = graph.bounded && dice.oneIn(3);
            if (dice.oneIn(2)) input.view = randomView(dice, input.eye);
            SceneConverter converter;
            const ConversionResult result = converter.convert(input);
            requireSound(result);
            // The next frame has the same graph: nothing may change.
            REQUIRE(converter.convert(input).scene->instances.size() ==
                    result.scene->instances.size());
            if (graph.bounded)
                REQUIRE(graphHash(*graph.root, ViewingConditions()) ==
                        graphHash(*graph.root, ViewingConditions()));

            const auto traced = TracedScene::build(result.scene, workers);
            uint64_t triangles = 0;
            for (const Instance& instance : result.scene->instances)
                triangles += result.scene->meshes[instance.mesh]->triangles.size();
            REQUIRE(traced->traits().triangles == triangles);
            seen +=
                requireFinitePass(traced, workers, IntegratorKind::Whitted, kSamplings[seed % 3]);
            requireFinitePass(traced, workers, IntegratorKind::Path, kSamplings[seed / 3 % 3]);
        });
    CHECK(seen > static_cast<uint64_t>(seedCount(kGraphs)) / 4);
}
