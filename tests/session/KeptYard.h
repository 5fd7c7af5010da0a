// KeptYard.h - a small scene in which a box moves, and views at rest of it. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include "tests/EngineScenes.h"
#include "tests/Environments.h"

#include <cstring>
#include <memory>
#include <vector>

namespace osgRayTrace::engine::test
{

constexpr int kWidth = 80, kHeight = 48;

/// Returns a floor with a pole on it and a box that stands at x, under a sun from the left and a
/// sky. What is the same in two scenes is shared.
struct Yard
{
    Yard()
    {
        const Material grey = lambert(Vec3(0.5f));
        builder.add(quadMesh({-60, -60, 0}, {120, 0, 0}, {0, 120, 0}), grey);
        builder.add(boxMesh({-9, 6, 0}, {-8, 7, 6}), lambert(Vec3(0.2f, 0.6f, 0.3f)));
        box = builder.add(boxMesh({-1, -1, 0}, {1, 1, 2}), lambert(Vec3(0.8f, 0.1f, 0.1f)));
        Light sun;
        sun.kind = LightKind::Directional;
        sun.diffuse = Vec3(0.6f);
        sun.direction = glm::normalize(Vec3(1.0f, 0.0f, -1.0f));
        builder.addLight(sun);
        builder.addLight(environmentLight(newEnvironment(2, 2, Vec3(0.4f))));
    }

    std::shared_ptr<Scene> at(float x) const
    {
        auto scene = std::make_shared<Scene>(*builder.scene);
        scene->instances[box].placed = true;
        scene->instances[box].engineFromLocal.translation = Vec3(x, 0.0f, 0.0f);
        return scene;
    }

    SceneBuilder builder;
    uint32_t box = 0;
};

inline std::shared_ptr<const TracedScene> traced(const std::shared_ptr<const Scene>& scene)
{
    return TracedScene::build(scene, std::make_shared<Workers>(1));
}

inline View yardView()
{
    return perspectiveView({0, -30, 14}, {0, 0, 1}, {0, 0, 1}, 40.0, kWidth, kHeight);
}

/// Returns options with which each sample of the even sky has noise of its own, so that kept
/// samples can be told from new ones: importance sampling would leave that sky to the rays that
/// surfaces send on, and have the same light for all of them.
inline RenderOptions noisyOptions(unsigned seed)
{
    RenderOptions options = optionsOf(IntegratorKind::Path, 8, seed);
    options.environmentSampling = EnvironmentSampling::Uniform;
    return options;
}

/// Traces frames of one pass each.
struct Watcher
{
    explicit Watcher(std::shared_ptr<const TracedScene> scene, bool keeps = true, unsigned seed = 0,
                     int threads = 1)
    {
        inputs.scene = std::move(scene);
        inputs.workers = std::make_shared<Workers>(threads);
        inputs.photons = std::make_shared<PhotonPasses>();
        inputs.options = noisyOptions(seed);
        inputs.maxPasses = 1 << 20;
        inputs.keepsUnchanged = keeps;
    }

    std::vector<float> show(const View& view = yardView())
    {
        rgba.assign(4u * std::size_t(view.width) * std::size_t(view.height), 0);
        std::vector<float> depth(rgba.size() / 4);
        tracer.trace(inputs, view, {}, rgba.data(), depth.data());
        if (tracer.needsResolve(inputs)) tracer.resolve(rgba.data(), depth.data());
        return tracer.radiance();
    }
    std::vector<float> show(const std::shared_ptr<const Scene>& scene)
    {
        inputs.scene = traced(scene);
        return show();
    }
    double share() const { return tracer.progress().stages.reprojectedShare; }

    ViewInputs inputs;
    ViewTracer tracer;
    std::vector<uint8_t> rgba;
};

/// Shows both watchers 24 frames in which the box comes nearer from the left, to x = 1.75.
inline void showMovingBox(const Yard& yard, Watcher& a, Watcher& b)
{
    for (int frame = 0; frame < 24; ++frame)
    {
        const auto scene = yard.at(-4.0f + 0.25f * float(frame));
        a.show(scene);
        b.show(scene);
    }
}

/// Returns what a session without any past makes of so many passes of a sequence.
inline std::vector<float> fresh(const std::shared_ptr<const Scene>& scene, uint32_t sequence,
                                int passes, const View& view = yardView())
{
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(traced(scene));
    session.setView(view);
    session.setOptions(noisyOptions(0));
    session.setSequence(sequence);
    StopRule rule;
    rule.passes = passes;
    session.render(rule);
    return session.resolveRadiance();
}

/// Returns a mark for each pixel in whose middle the instance is seen.
inline std::vector<uint8_t> pixelsOf(uint32_t instance, const std::shared_ptr<const Scene>& scene,
                                     const View& view = yardView())
{
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(traced(scene));
    session.setView(view);
    StopRule rule;
    rule.passes = 1;
    session.render(rule);
    std::vector<uint8_t> marks;
    for (const SurfaceSample& sample : session.surfaceSamples())
        marks.push_back(sample.object == instance + 1);
    return marks;
}

inline bool samePixel(const std::vector<float>& a, const std::vector<float>& b, std::size_t pixel)
{
    return std::memcmp(&a[4 * pixel], &b[4 * pixel], 4 * sizeof(float)) == 0;
}

/// Holds frames of a scene that has just changed, after two pasts: so many passes of the scene
/// before that no pixel that keeps some gets more. The frames differ where they hold what
/// was kept, and only there.
struct TwoPasts
{
    TwoPasts(const std::shared_ptr<const Scene>& before, const std::shared_ptr<const Scene>& after,
             const View& view = yardView())
    {
        for (const int past : {0, 1})
        {
            Watcher watcher(traced(before));
            for (int frame = 0; frame < (past == 0 ? 16 : 24); ++frame)
                last[past] = watcher.show(view);
            watcher.inputs.scene = traced(after);
            kept[past] = watcher.show(view);
            share = watcher.share();
        }
    }
    bool tellApart(std::size_t pixel) const { return !samePixel(kept[0], kept[1], pixel); }

    std::vector<float> last[2], kept[2]; ///< pictures before and after the change
    double share = 0.0;                  ///< share of the pixels that hold what was kept
};

inline float brightness(const std::vector<float>& picture, std::size_t pixel)
{
    return picture[4 * pixel] + picture[4 * pixel + 1] + picture[4 * pixel + 2];
}

} // namespace osgRayTrace::engine::test
