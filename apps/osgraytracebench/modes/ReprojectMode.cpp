// ReprojectMode.cpp - error and cost of a moving view with and without reprojection. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/ReprojectMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/modes/FrameWalker.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "osgRayTrace/base/Parallel.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <memory>

namespace osgRayTrace::bench
{

namespace
{

using namespace engine;

constexpr int kWarmUp = 20;  ///< frames before the first that is measured
constexpr int kMeasured = 2; ///< measured frames, kStride apart
constexpr int kStride = 7;

/// Returns the view of a head that sways and looks around in the box: one to two pixels a frame at
/// a width of 320.
View viewAt(int frame, int width)
{
    const double t = frame;
    const Vec3d eye(278.0 + 40.0 * std::sin(0.06 * t), 278.0 + 25.0 * std::sin(0.045 * t),
                    20.0 + 8.0 * std::sin(0.03 * t));
    const Vec3d centre(278.0 + 60.0 * std::sin(0.04 * t), 250.0, 559.0);
    View view;
    view.width = width;
    view.height = width * 9 / 16;
    view.viewFromWorld = glm::lookAt(eye, centre, Vec3d(0, 1, 0));
    view.clipFromView =
        glm::perspective(glm::radians(50.0), double(view.width) / view.height, 1.0, 10000.0);
    return view;
}

/// Returns a texture of sixteen cells a side, of two grays, with finer cells in them.
std::shared_ptr<const Texture> cells()
{
    auto result = std::make_shared<Texture>();
    Texture& texture = *result;
    texture.width = texture.height = 256;
    texture.opaque = true;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
        {
            const int coarse = ((x >> 4) + (y >> 4)) & 1, fine = ((x >> 2) ^ (y >> 2)) & 1;
            const auto value = static_cast<uint8_t>(60 + 120 * coarse + 60 * fine);
            texture.bytes.insert(texture.bytes.end(),
                                 {value, value, static_cast<uint8_t>(value / 2 + 100), 255});
        }
    return result;
}

enum class Look
{
    Diffuse,
    Glossy,
    Textured,
    Mirror,
};

std::shared_ptr<const TracedScene> sceneOf(Look look, const std::shared_ptr<Workers>& workers)
{
    auto scene = std::make_shared<Scene>(*cornellBox(16, 9).scene);
    if (look == Look::Glossy || look == Look::Mirror)
        for (Material& material : scene->materials)
            if (material.model == MaterialModel::Physical && material.baseColor == Vec3(0.73f))
            {
                material.metallic = 1.0f;
                material.roughness = look == Look::Glossy ? 0.5f : 0.0f;
            }
    if (look == Look::Textured)
    {
        scene->textures.push_back(cells());
        for (Material& material : scene->materials)
            if (material.baseColor == Vec3(0.73f))
                material.baseColorTexture = static_cast<uint32_t>(scene->textures.size() - 1);
        for (auto& mesh : scene->meshes)
        {
            auto mapped = std::make_shared<Mesh>(*mesh);
            mapped->uvs = std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            mesh = mapped;
        }
    }
    return TracedScene::build(scene, workers);
}

void measureErrors(Rows& rows, const ReprojectOptions& options, const std::string& name, Look look,
                   bool goal)
{
    const auto workers = std::make_shared<Workers>();
    const auto scene = sceneOf(look, workers);
    FrameWalker with(scene, workers), without(scene, workers);
    with.inputs.reprojects = true;
    double errorWith = 0.0, errorWithout = 0.0, secondsWith = 0.0, secondsWithout = 0.0;
    for (int frame = 0, measured = 0; measured < kMeasured; ++frame)
    {
        const View view = viewAt(frame, options.width);
        secondsWithout += without.show(view);
        secondsWith += with.show(view);
        if (frame < kWarmUp + kStride * measured) continue;
        ++measured;
        const std::vector<float> reference = referenceOf(scene, workers, view, options.references);
        errorWith += relMseOf(with.tracer.radiance(), reference) / kMeasured;
        errorWithout += relMseOf(without.tracer.radiance(), reference) / kMeasured;
        if (measured < kMeasured || options.pictures.empty()) continue;
        const std::string stem = options.pictures + "/" + name + "-";
        writePicture(stem + "with.png", view, with.tracer.radiance());
        writePicture(stem + "without.png", view, without.tracer.radiance());
        writePicture(stem + "reference.png", view, reference);
        std::vector<float> difference = with.tracer.radiance();
        for (std::size_t i = 0; i < difference.size(); ++i)
            difference[i] = 0.5f + difference[i] - reference[i];
        writePicture(stem + "difference.png", view, difference);
    }
    // In the time that a frame takes with reprojection there would be more passes without it.
    const double passes = secondsWith / secondsWithout;
    rows.push_back({name + ": relMSE without", errorWithout, ""});
    rows.push_back({name + ": relMSE with reprojection", errorWith, ""});
    rows.push_back({name + ": pixels reprojected",
                    100.0 * with.tracer.progress().stages.reprojectedShare, "%"});
    rows.push_back({name + ": CPU time with / without", passes, "times"});
    rows.push_back({name + ": relMSE without / with, at equal time",
                    errorWithout / passes / errorWith, "times", goal ? Goal::AtLeast : Goal::None,
                    2.0});
}

/// Measures frames of 1920 x 1080 of the cheapest kind: the time of carrying, and of the whole
/// frame.
void measureCosts(Rows& rows, int threads)
{
    const auto workers = std::make_shared<Workers>(threads);
    const auto scene = sceneOf(Look::Diffuse, workers);
    FrameWalker with(scene, workers), without(scene, workers);
    with.inputs.reprojects = true;
    for (FrameWalker* walker : {&with, &without})
        walker->inputs.options.integrator = IntegratorKind::Whitted;
    std::vector<double> carried, shares, added, plain;
    for (int frame = 0; frame < 8; ++frame)
    {
        const double alone = without.show(viewAt(frame, 1920));
        const double all = with.show(viewAt(frame, 1920));
        if (frame < 2)
            continue; // the first that carries makes the map of the view that it leaves, too
        carried.push_back(with.tracer.progress().stages.reprojectSeconds);
        shares.push_back(with.tracer.progress().stages.reprojectedShare);
        added.push_back(all - alone);
        plain.push_back(alone);
    }
    const std::string name =
        "1920 x 1080, " + std::to_string(threads) + (threads > 1 ? " threads: " : " thread: ");
    rows.push_back({name + "a frame of WHITTED, CPU time", 1e3 * median(plain), "ms"});
    rows.push_back({name + "added by reprojection, CPU time", 1e3 * median(added), "ms"});
    rows.push_back({name + "carrying the history, on the wall", 1e3 * median(carried), "ms"});
    rows.push_back({name + "pixels reprojected", 100.0 * median(shares), "%"});
}

} // namespace

void measureReprojection(const ReprojectOptions& options, Rows& rows)
{
    measureErrors(rows, options, "diffuse", Look::Diffuse, true);
    measureErrors(rows, options, "glossy", Look::Glossy, true);
    measureErrors(rows, options, "textured", Look::Textured, true);
    measureErrors(rows, options, "mirror", Look::Mirror, false);
    if (!options.costs) return;
    measureCosts(rows, 1);
    measureCosts(rows, 2);
}

} // namespace osgRayTrace::bench
