// Squares.h - unlit squares and their pictures, traced and drawn by OSG. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/MatrixTransform>
#include <osgDB/WriteFile>

#include <cstdlib>
#include <string>

namespace osgRayTrace::test
{

constexpr int kSize = 96;

/// Returns unlit squares whose edges do not meet: two ways to draw them may differ only at edges.
inline osg::ref_ptr<osg::Group> squares()
{
    const struct
    {
        osg::Vec3d at;
        float half;
        osg::Vec4 color;
    } all[] = {{{0.3, 0.2, 6.0}, 0.6f, {1, 0, 0, 1}},
               {{-1.0, 0.4, 2.0}, 1.2f, {0, 1, 0, 1}},
               {{1.5, -1.0, -8.0}, 4.0f, {0, 0, 1, 1}},
               {{-6.0, 8.0, -70.0}, 20.0f, {1, 1, 0, 1}}};
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const auto& square : all)
    {
        // The squares are tilted, so that the slices cut them.
        osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::rotate(0.7, osg::Vec3d(0.3, 1.0, 0.0)) *
                                     osg::Matrixd::translate(square.at));
        place->addChild(unlitSquare(square.half, square.color));
        group->addChild(place);
    }
    return group;
}

inline osg::ref_ptr<RayTracedScene> tracedSquares(int passesPerFrame = 1)
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(squares().get());
    scene->getSettings()->setPassesPerFrame(passesPerFrame);
    return scene;
}

inline Statistics statistics(const RayTracedScene& scene)
{
    return scene.getDrawable()->getStatistics();
}

inline void keep(const std::string& name, const osg::Image& image)
{
    if (const char* folder = std::getenv("OSGRAYTRACE_PICTURES"))
        osgDB::writeImageFile(image, std::string(folder) + "/" + name + ".png");
}

/// Returns the picture, after this many frames, of a scene whose viewer is prepared by setUp.
template <class SetUp>
osg::ref_ptr<osg::Image> picture(osg::Node* scene, const SetUp& setUp, int frames = 1)
{
    TestViewer view(kSize, kSize, scene);
    setUp(view);
    return view.frames(frames);
}

/// Returns the share of the pixels of one colour to which OpenGL gives another colour: it is not
/// small if matrices or eyes differ.
inline double differenceInside(const std::string& name, const osg::Image& drawn,
                               const osg::Image& traced)
{
    keep(name + "-osg", drawn);
    keep(name + "-traced", traced);
    REQUIRE((drawn.s() == traced.s() && drawn.t() == traced.t()));
    long inside = 0, wrong = 0, colored = 0;
    for (int y = 0; y < drawn.t(); ++y)
        for (int x = 0; x < drawn.s(); ++x)
        {
            const osg::Vec4 t = pixel(traced, x, y);
            bool pure = true;
            for (int c = 0; c < 3; ++c)
                pure = pure && (t[c] == 0.0f || t[c] == 255.0f);
            if (!pure) continue;
            ++inside;
            colored += t.r() + t.g() + t.b() > 0.0f;
            wrong += (t - pixel(drawn, x, y)).length() > 0.0f;
        }
    CHECK(inside > drawn.s() * drawn.t() * 3 / 4);
    CHECK(colored > drawn.s() * drawn.t() / 8);
    return double(wrong) / double(inside);
}

} // namespace osgRayTrace::test
