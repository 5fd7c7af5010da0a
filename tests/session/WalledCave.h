// WalledCave.h - the walls of a CAVE, whose tiles have costs that tests choose.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace osgRayTrace::engine::test
{

constexpr int kWidth = 160, kHeight = 128, kMaxPasses = 4; // 80 tiles
constexpr double kBudget = 250.0;

/// Returns the view of one of several walls beside each other, all seen from x.
inline View viewOf(int wall, double x)
{
    return perspectiveView({278 + x, 278, 20}, {78 + 200.0 * wall, 250, 559}, {0, 1, 0}, 40.0,
                           kWidth, kHeight);
}

/// Tells the state of a wall's picture after a frame.
struct WallPicture
{
    int divider = 0, passes = 0, width = 0;
    bool operator==(const WallPicture& other) const
    {
        return divider == other.divider && passes == other.passes && width == other.width;
    }
};

/// Shows a scene on several walls. Each traced tile moves the clock on by the cost of its wall.
struct Cave
{
    explicit Cave(const std::vector<double>& costs) : agreement(std::make_shared<FrameAgreement>())
    {
        inputs.options.integrator = IntegratorKind::Whitted;
        inputs.options.lightSamples = 1;
        inputs.maxPasses = kMaxPasses;
        inputs.scene = cornellBox().build();
        inputs.workers = std::make_shared<Workers>(2);
        inputs.photons = std::make_shared<PhotonPasses>();
        for (const double cost : costs)
            add(cost);
    }

    void add(double cost)
    {
        walls.push_back(std::make_unique<Wall>(clock));
        walls.back()->cost = cost;
        walls.back()->number = static_cast<int>(walls.size()) - 1;
    }

    struct Wall
    {
        explicit Wall(std::atomic<double>& clock) : tracer([&clock] { return clock.load(); })
        {
            tracer.setInterrupt(
                [this, &clock]
                {
                    double now = clock;
                    while (!clock.compare_exchange_weak(now, now + cost))
                    {
                    }
                    return false;
                });
        }
        double cost = 1.0;
        int number = 0;
        std::vector<uint8_t> rgba;
        std::vector<float> depth;
        int displayWidth = 0;
        ViewTracer tracer;
    };

    FrameBudget frameBudget(bool equal = true) const
    {
        FrameBudget frame;
        frame.seconds = budget;
        frame.degrade = degrade;
        frame.upsampleShare = 0.0;
        if (equal) frame.agreement = agreement;
        frame.frameNumber = number;
        return frame;
    }

    WallPicture draw(Wall& wall, double x, bool equal = true)
    {
        ViewTracer& tracer = wall.tracer;
        const View view = viewOf(wall.number, x);
        const bool fits = wall.displayWidth == kWidth;
        tracer.trace(inputs, view, frameBudget(equal), fits ? wall.rgba.data() : nullptr,
                     fits ? wall.depth.data() : nullptr);
        if (tracer.needsResolve(inputs))
        {
            const auto pixels = std::size_t(tracer.displayWidth() * tracer.displayHeight());
            wall.rgba.resize(4 * pixels);
            wall.depth.resize(pixels);
            wall.displayWidth = tracer.displayWidth();
            tracer.resolve(wall.rgba.data(), wall.depth.data());
        }
        tracer.recordPresented();
        return {tracer.frame().divider, tracer.progress().passes, wall.displayWidth};
    }

    /// Draws one wall after the other.
    std::vector<WallPicture> frame(double x, bool equal = true)
    {
        ++number;
        const double begin = clock;
        std::vector<WallPicture> pictures;
        for (const auto& wall : walls)
            pictures.push_back(draw(*wall, x, equal));
        seconds = clock - begin;
        return pictures;
    }

    std::atomic<double> clock{0.0};
    double budget = kBudget;
    bool degrade = true;
    double seconds = 0.0; ///< taken by the last frame
    uint64_t number = 100;
    ViewInputs inputs;
    std::shared_ptr<FrameAgreement> agreement;
    std::vector<std::unique_ptr<Wall>> walls; ///< declared after what they refer to
};

inline bool allSame(const std::vector<WallPicture>& pictures)
{
    return std::all_of(pictures.begin(), pictures.end(),
                       [&](const WallPicture& picture) { return picture == pictures.front(); });
}

/// Returns the picture that a session without a deadline makes of a view.
inline std::vector<uint8_t> reference(const Cave& cave, int wall, double x,
                                      const WallPicture& shown)
{
    View view = viewOf(wall, x);
    view.width = reducedSize(kWidth, shown.divider);
    view.height = reducedSize(kHeight, shown.divider);
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(cave.inputs.scene);
    session.setView(view);
    RenderOptions options = cave.inputs.options;
    options.centredFirstPass = shown.divider > 1;
    session.setCentred(shown.divider > 1);
    session.setOptions(options);
    StopRule rule;
    rule.passes = shown.passes;
    session.render(rule);
    std::vector<uint8_t> rgba(4 * std::size_t(view.width * view.height));
    session.resolveDisplay({0.0f, false}, rgba.data(), nullptr);
    return rgba;
}

} // namespace osgRayTrace::engine::test
