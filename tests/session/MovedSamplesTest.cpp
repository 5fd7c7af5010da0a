// MovedSamplesTest.cpp - an object that moves takes its samples along, and no others.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/MovedSamples.h"

#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/session/KeptYard.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

View nearView()
{
    return perspectiveView({0, -8, 5}, {0, 0, 1}, {0, 0, 1}, 40.0, kWidth, kHeight);
}

View parallelView()
{
    View view = nearView();
    view.clipFromView = glm::ortho(-5.0, 5.0, -3.0, 3.0, 1.0, 30.0);
    return view;
}

/// Returns the yard with its box turned about the vertical axis.
std::shared_ptr<Scene> turned(const Yard& yard, float angle)
{
    auto scene = yard.at(0.0f);
    const float c = std::cos(angle), s = std::sin(angle);
    scene->instances[yard.box].engineFromLocal.linear =
        Mat3(Vec3(c, s, 0), Vec3(-s, c, 0), Vec3(0, 0, 1));
    return scene;
}

/// Returns the yard with a box whose colour goes from dark to bright along its way.
Yard shadedYard()
{
    Yard yard;
    const Instance& box = yard.builder.scene->instances[yard.box];
    auto mesh = std::make_shared<Mesh>(*yard.builder.scene->meshes[box.mesh]);
    std::vector<Vec4> colors;
    for (const Vec3& p : mesh->positions)
        colors.push_back(Vec4(Vec3(0.55f + 0.45f * p.x), 1.0f));
    mesh->colors = SharedArray<Vec4>(std::move(colors));
    yard.builder.scene->meshes[box.mesh] = mesh;
    auto detail = std::make_shared<MaterialDetail>();
    detail->vertexColors = true;
    yard.builder.scene->materials[box.material].detail = detail;
    return yard;
}

double squaredErrorOf(const std::vector<float>& picture, const std::vector<float>& reference,
                      const std::vector<uint8_t>& marks)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < marks.size(); ++i)
        for (std::size_t c = 4 * i; marks[i] && c < 4 * i + 3; ++c)
            sum += (double(picture[c]) - reference[c]) * (double(picture[c]) - reference[c]);
    return sum;
}

double sumOf(const std::vector<float>& picture, const std::vector<uint8_t>& marks)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i]) sum += double(brightness(picture, i));
    return sum;
}

} // namespace

TEST_CASE("moved samples: rigid moves alone are told", "[session]")
{
    const Yard yard;
    const auto before = yard.at(1.0f);
    const auto movesOf = [&](const std::shared_ptr<Scene>& after)
    {
        const auto change = sceneChange(*before, *after);
        REQUIRE(change);
        CHECK(change->instances.size() == 1);
        return change->moves;
    };
    const std::vector<RigidMove> step = movesOf(yard.at(1.5f));
    REQUIRE(step.size() == 1);
    CHECK(step[0].instance == yard.box);
    CHECK(glm::length(Vec3d(step[0].afterFromBefore[3]) - Vec3d(0.5, 0, 0)) < 1e-6);
    CHECK(step[0].before.low.x == Approx(0.0f).margin(1e-6));
    CHECK(step[0].after.low.x == Approx(0.5f));

    const std::vector<RigidMove> turn = movesOf(turned(yard, 0.5f));
    REQUIRE(turn.size() == 1);
    const Vec4d corner = turn[0].afterFromBefore * Vec4d(2, 0, 0, 1); // the local (1, 0, 0)
    CHECK(glm::length(Vec3d(corner) - Vec3d(std::cos(0.5), std::sin(0.5), 0)) < 1e-6);

    auto larger = yard.at(1.5f);
    larger->instances[yard.box].engineFromLocal.linear *= 1.01f;
    CHECK(movesOf(larger).empty());
    auto mirrored = yard.at(1.5f);
    mirrored->instances[yard.box].engineFromLocal.linear[0] *= -1.0f;
    CHECK(movesOf(mirrored).empty());
    auto painted = yard.at(1.5f);
    painted->materials[painted->instances[yard.box].material].changed = 9;
    CHECK(movesOf(painted).empty());
    auto bent = yard.at(1.5f);
    std::shared_ptr<const Mesh>& mesh = bent->meshes[bent->instances[yard.box].mesh];
    mesh = std::make_shared<Mesh>(*mesh);
    CHECK(movesOf(bent).empty());
}

TEST_CASE("moved samples: a window of a map has the rays of its pixels", "[session]")
{
    const PixelWindow window{13, 7, 45, 30};
    SurfaceMap map;
    for (const View& view : {nearView(), yardView(), parallelView()})
    {
        REQUIRE(beginSurfaceMap(view, map));
        for (std::size_t i = 0; i < map.object.size(); ++i)
            map.object[i] = static_cast<uint32_t>(i);
        const SurfaceMap part = cutMap(map, window, Workers(1));
        REQUIRE(part.object.size() == window.area());
        CHECK(part.object[0] == 7u * kWidth + 13u);
        CHECK(part.object.back() == 29u * kWidth + 44u);
        const PixelRays own = *pixelRays(windowView(view, window));
        for (const Vec2 at : {Vec2(0.5f, 0.5f), Vec2(31.5f, 22.5f)})
        {
            const auto startOf = [at](const PixelRays& rays)
            {
                const CameraRays& r = rays.rays;
                return Vec3(rays.pole) + r.origin + at.x * r.originDx + at.y * r.originDy;
            };
            const auto directionOf = [at](const PixelRays& rays)
            {
                const CameraRays& r = rays.rays;
                return glm::normalize(r.direction + at.x * r.directionDx + at.y * r.directionDy);
            };
            CHECK(glm::length(directionOf(own) - directionOf(part.rays)) < 1e-5f);
            CHECK(glm::length(startOf(own) - startOf(part.rays)) < 1e-4f);
        }
    }
}

TEST_CASE("moved samples: a box on its way has a part of the error of a fresh start", "[session]")
{
    const Yard yard;
    const auto check = [&](const View& view, bool turns)
    {
        const auto sceneAt = [&](int frame)
        {
            const auto t = static_cast<float>(frame);
            return turns ? turned(yard, 0.012f * t) : yard.at(-0.8f + 0.06f * t);
        };
        Watcher watcher(traced(sceneAt(0)));
        std::vector<float> picture;
        for (int frame = 0; frame < 25; ++frame)
        {
            watcher.inputs.scene = traced(sceneAt(frame));
            picture = watcher.show(view);
        }
        const auto last = sceneAt(24);
        const std::vector<uint8_t> box = pixelsOf(yard.box, last, view);
        const std::vector<float> reference = fresh(last, 9, 256, view);
        const double kept = squaredErrorOf(picture, reference, box),
                     plain = squaredErrorOf(fresh(last, 24, 1, view), reference, box);
        INFO(plain << " to " << kept << " in " << std::count(box.begin(), box.end(), 1));
        CHECK(kept < 0.25 * plain);
    };
    check(nearView(), false);
    check(nearView(), true);
    check(parallelView(), false);
}

TEST_CASE("moved samples: what a look at the light or the surface forbids is not taken",
          "[session]")
{
    const View view = nearView();
    const auto takenOf = [&](const std::function<void(Yard&)>& edit, float step)
    {
        Yard yard;
        edit(yard);
        const auto before = yard.at(0.0f), after = yard.at(step);
        const TwoPasts pasts(before, after, view);
        const std::vector<uint8_t> box = pixelsOf(yard.box, after, view);
        int taken = 0;
        for (std::size_t i = 0; i < box.size(); ++i)
            taken += box[i] && pasts.tellApart(i);
        return double(taken) / double(std::count(box.begin(), box.end(), uint8_t(1)));
    };
    const auto materialOf = [](Yard& yard) -> Material&
    { return yard.builder.scene->materials[yard.builder.scene->instances[yard.box].material]; };
    CHECK(takenOf([](Yard&) {}, 0.06f) > 0.95);
    CHECK(takenOf([&](Yard& yard) { materialOf(yard) = mirror(Vec3(0.9f)); }, 0.06f) == 0.0);
    // The box is 3.46 long from corner to corner.
    CHECK(takenOf([](Yard&) {}, 3.4f) > 0.5);
    CHECK(takenOf([](Yard&) {}, 3.6f) == 0.0);
    CHECK(takenOf([&](Yard& yard)
                  { materialOf(yard).mapping.coordinates = TextureCoordinates::Position; },
                  0.06f) == 0.0);
    // Ten steps are a tenth of the way to the lamp, or longer than the way to the lamp.
    const auto lampAt = [](Vec3 place)
    {
        return [place](Yard& yard)
        {
            Light& lamp = yard.builder.scene->lights[0];
            lamp.kind = LightKind::Point;
            lamp.position = place;
        };
    };
    CHECK(takenOf(lampAt({0.0f, 0.0f, 8.0f}), 0.06f) > 0.95);
    CHECK(takenOf(lampAt({0.0f, 0.0f, 2.5f}), 0.06f) == 0.0);
}

TEST_CASE("moved samples: the light on a box is that of its place", "[session][statistics]")
{
    // Sixteen ways of nine frames; a false alarm has a probability of 1e-3, see Estimate::agrees.
    // The box goes on through even light, and its pixels are right but for what mixes with the
    // floor at its edges. If it turns by 0.08 in each frame it takes along 1.25 samples, whose mean
    // age is as many frames: then its light lags behind by some percent.
    const Yard yard;
    const View view = nearView();
    for (const bool turns : {false, true})
    {
        const auto sceneAt = [&](int frame)
        {
            const auto t = static_cast<float>(frame);
            return turns ? turned(yard, -0.08f * t) : yard.at(0.06f * t);
        };
        const std::vector<uint8_t> box = pixelsOf(yard.box, sceneAt(8), view);
        const double expected = sumOf(fresh(sceneAt(8), 99, 512, view), box);
        Estimate mean;
        for (unsigned seed = 0; seed < 16; ++seed)
        {
            Watcher watcher(traced(sceneAt(0)), true, seed);
            std::vector<float> picture;
            for (int frame = 0; frame < 9; ++frame)
            {
                watcher.inputs.scene = traced(sceneAt(frame));
                picture = watcher.show(view);
            }
            mean.add(sumOf(picture, box) / expected);
        }
        INFO(mean.mean() << " +- " << mean.standardError());
        CHECK(mean.agrees(1.0, turns ? 0.05 : 0.01));
    }
}

TEST_CASE("moved samples: at rest the image becomes that of a fresh start", "[session]")
{
    const Yard yard;
    const View view = nearView();
    Watcher watcher(traced(yard.at(0.0f)));
    for (int frame = 0; frame < 10; ++frame)
    {
        watcher.inputs.scene = traced(yard.at(0.06f * float(frame)));
        watcher.show(view);
    }
    const auto last = yard.at(0.06f * 9.0f);
    const std::vector<uint8_t> box = pixelsOf(yard.box, last, view);
    const auto followed = [&](const std::vector<float>& picture, const std::vector<float>& own)
    {
        int different = 0;
        for (std::size_t i = 0; i < box.size(); ++i)
            different += box[i] && !samePixel(picture, own, i);
        return different;
    };
    CHECK(followed(watcher.tracer.radiance(), fresh(last, 9, 1, view)) > 250);
    // Each pass takes the weight of half a sample: eight are gone after seventeen passes.
    std::vector<float> picture;
    for (int pass = 2; pass <= 17; ++pass)
        picture = watcher.show(view);
    CHECK(followed(picture, fresh(last, 9, 17, view)) == 0);
}

TEST_CASE("moved samples: a lamp's place is that of its mesh, after it has moved, too", "[session]")
{
    Yard yard;
    Light lamp;
    lamp.kind = LightKind::Mesh;
    lamp.instance = yard.box;
    lamp.changed = 1;
    LampPlaces places;
    const auto placeAt = [&](float x, Stamp changed)
    {
        lamp.changed = changed;
        const std::vector<Vec3> found = places.of({lamp}, *yard.at(x));
        REQUIRE(found.size() == 1);
        return found[0];
    };
    CHECK(glm::length(placeAt(0.0f, 1) - Vec3(0, 0, 1)) < 1e-5f);
    CHECK(glm::length(placeAt(0.0f, 1) - Vec3(0, 0, 1)) < 1e-5f);
    CHECK(glm::length(placeAt(3.0f, 2) - Vec3(3, 0, 1)) < 1e-5f);
    yard.builder.scene->meshes[yard.builder.scene->instances[yard.box].mesh] =
        std::make_shared<Mesh>(*boxMesh({-1, -1, 0}, {1, 1, 4}));
    CHECK(glm::length(placeAt(3.0f, 2) - Vec3(3, 0, 2)) < 1e-5f);
}

TEST_CASE("moved samples: what carry may set is told before", "[session]")
{
    // The box fills much of the view, leaves it, or is a mirror.
    const View view = perspectiveView({0, -6, 2}, {0, 0, 1}, {0, 0, 1}, 40.0, kWidth, kHeight);
    const auto tellOf = [&](const Yard& yard, float from, float to)
    {
        const auto before = yard.at(from), after = yard.at(to);
        const auto change = sceneChange(*before, *after);
        REQUIRE(change);
        const auto workers = std::make_shared<Workers>(1);
        RenderSession session(workers);
        session.setScene(traced(before));
        session.setView(view);
        StopRule rule;
        rule.passes = 1;
        session.render(rule);
        SampledImage image;
        image.width = kWidth;
        image.height = kHeight;
        image.radiance.assign(4u * kWidth * kHeight, 0.5f);
        image.count.assign(std::size_t(kWidth) * kHeight, 1.0f);
        MovedSamples moved;
        moved.take(session.firstSurfaces(), *before, before->lights, *change, image, *workers);
        return moved.pixels();
    };
    const Yard plain;
    const std::vector<uint8_t> seen = pixelsOf(plain.box, plain.at(0.0f), view);
    const auto box = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), uint8_t(1)));
    REQUIRE(box > 300);
    CHECK(std::abs(double(tellOf(plain, 0.0f, 0.06f)) - double(box)) < 0.1 * double(box));
    CHECK(tellOf(plain, 1.0f, 4.4f) < 3 * box / 4); // most of it is then beyond the border
    CHECK(tellOf(plain, 9.0f, 9.06f) == 0);         // it is off the screen
    CHECK(tellOf(plain, 2.2f, 5.6f) == 0);
    Yard mirrored;
    mirrored.builder.scene->materials[mirrored.builder.scene->instances[mirrored.box].material] =
        mirror(Vec3(0.9f));
    CHECK(tellOf(mirrored, 0.0f, 0.06f) == 0);
}

TEST_CASE("moved samples: no ghosts of other places are on the box", "[session][statistics]")
{
    // The means of sixteen ways are compared pixel by pixel where the box and no edge is seen. The
    // box is bright on one side and dark on the other: it shows which place a sample comes from. A
    // pixel is wrong if its mean is off by a tenth and four standard errors more.
    const Yard yard = shadedYard();
    const View view = nearView();
    const auto sceneAt = [&](int frame) { return yard.at(0.06f * static_cast<float>(frame)); };
    constexpr int kLast = 8;
    std::vector<uint8_t> box = pixelsOf(yard.box, sceneAt(kLast), view);
    const std::vector<float> reference = fresh(sceneAt(kLast), 99, 512, view);
    std::vector<Estimate> means(box.size());
    for (unsigned seed = 0; seed < 16; ++seed)
    {
        Watcher watcher(traced(sceneAt(0)), true, seed);
        std::vector<float> picture;
        for (int frame = 0; frame <= kLast; ++frame)
        {
            watcher.inputs.scene = traced(sceneAt(frame));
            picture = watcher.show(view);
        }
        for (std::size_t i = 0; i < box.size(); ++i)
            means[i].add(double(brightness(picture, i)));
    }
    int examined = 0, ghosts = 0;
    const auto isInside = [&](std::size_t i)
    {
        bool inside = true;
        for (const int dy : {-1, 0, 1})
            for (const int dx : {-1, 0, 1})
            {
                const std::size_t other = i + std::size_t(dx + dy * kWidth);
                const float ratio = brightness(reference, other) / brightness(reference, i);
                inside = inside && box[other] && ratio > 0.8f && ratio < 1.25f;
            }
        return inside;
    };
    for (std::size_t i = kWidth + 1; i + kWidth + 1 < box.size(); ++i)
    {
        if (!box[i] || !isInside(i)) continue;
        ++examined;
        const double wanted = double(brightness(reference, i));
        ghosts +=
            std::abs(means[i].mean() - wanted) > 0.1 * wanted + 4.0 * means[i].standardError();
    }
    CAPTURE(examined, ghosts);
    CHECK(examined > 100);
    CHECK(ghosts == 0);
}
