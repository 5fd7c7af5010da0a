// MatchPictures.h - a scene drawn by OpenGL and traced, and how much the pictures differ. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/NodeVisitor>
#include <osgDB/WriteFile>
#include <osgGA/TrackballManipulator>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// Holds the colour and the coverage of a picture.
struct Picture
{
    osg::ref_ptr<osg::Image> color;
    std::vector<bool> covered; ///< whether anything is within the pixel
};

/// How the two pictures of a scene are made.
struct MatchSetup
{
    int width = 120, height = 90;
    int samples =
        4; ///< a pixel and axis, of the rasterized picture; squared, passes of the traced one
    bool homeView = false;                      ///< osgviewer's view instead of TestViewer's
    std::function<void(TestViewer&)> view = {}; ///< further changes
    std::function<void(RayTraceSettings&)> settings = {}; ///< of the traced picture
};

inline bool isCovered(const osg::Image& depth, int x, int y)
{
    return *reinterpret_cast<const float*>(depth.data(x, y)) < 1.0f;
}

/// Reduces samples to pixels. A pixel is covered if any of its samples is.
inline Picture reduced(const osg::Image& color, const osg::Image& depth, const MatchSetup& setup)
{
    const int n = setup.samples;
    Picture small{reduced(color, n), {}};
    for (int y = 0; y < setup.height; ++y)
        for (int x = 0; x < setup.width; ++x)
        {
            bool any = false;
            for (int i = 0; i < n * n; ++i)
                any = any || isCovered(depth, x * n + i % n, y * n + i / n);
            small.covered.push_back(any);
        }
    return small;
}

inline void setUp(TestViewer& view, const MatchSetup& setup)
{
    if (setup.homeView)
    {
        view.camera().setComputeNearFarMode(osg::Camera::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        view.viewer.setCameraManipulator(new osgGA::TrackballManipulator);
    }
    if (setup.view) setup.view(view);
    if (setup.homeView) view.frames(); // the manipulator goes home
}

/// OSG's first frame is not like the later ones: state that OSG sets last stays for the next frame,
/// and pictures are still being loaded. So the pictures are those of the third frame.
constexpr int kFramesBefore = 2;

inline Picture rasterize(osg::Node* model, const MatchSetup& setup)
{
    TestViewer view(setup.width * setup.samples, setup.height * setup.samples, model);
    setUp(view, setup);
    const osg::ref_ptr<osg::Image> color = view.frames(kFramesBefore + 1);
    return reduced(*color, *view.capture->getDepthImage(), setup);
}

inline Picture rayTrace(osg::Node* model, const MatchSetup& setup, Statistics* wanted = nullptr)
{
    const osg::ref_ptr<RayTracedScene> scene = tracedScene(model);
    const int passes = setup.samples * setup.samples * 4;
    scene->getSettings()->setPassesPerFrame(1);
    if (setup.settings) setup.settings(*scene->getSettings());
    TestViewer view(setup.width, setup.height, scene.get());
    setUp(view, setup);
    view.frames(kFramesBefore);
    scene->getSettings()->setPassesPerFrame(passes);
    Picture picture{view.frames(), {}};
    const Statistics statistics = scene->getDrawable()->getStatistics();
    REQUIRE(statistics.ok);
    REQUIRE(statistics.passes >= passes);
    if (wanted) *wanted = statistics;
    for (int y = 0; y < setup.height; ++y)
        for (int x = 0; x < setup.width; ++x)
            picture.covered.push_back(isCovered(*view.capture->getDepthImage(), x, y));
    return picture;
}

struct Comparison
{
    double difference; ///< mean over the pixels that both cover, 0 to 255
    int both;
    int either;
};

inline Comparison compare(const Picture& a, const Picture& b)
{
    Comparison comparison{};
    const int width = a.color->s();
    const auto both = [&](int x, int y)
    {
        const auto i = std::size_t(y * width + x);
        return a.covered[i] && b.covered[i];
    };
    for (std::size_t i = 0; i < a.covered.size(); ++i)
    {
        comparison.both += a.covered[i] && b.covered[i];
        comparison.either += a.covered[i] || b.covered[i];
    }
    comparison.difference = meanDifference(*a.color, *b.color, both);
    return comparison;
}

/// Writes the two pictures beside each other if OSGRAYTRACE_PICTURES names a folder.
inline void keepPictures(const std::string& name, const Picture& traced, const Picture& rasterized)
{
    const char* folder = std::getenv("OSGRAYTRACE_PICTURES");
    if (!folder) return;
    const osg::Image& a = *traced.color;
    osg::ref_ptr<osg::Image> pair = new osg::Image;
    pair->allocateImage(2 * a.s() + 8, a.t(), 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::memset(pair->data(), 255, pair->getTotalSizeInBytes());
    for (int side = 0; side < 2; ++side)
        for (int y = 0; y < a.t(); ++y)
            for (int x = 0; x < a.s(); ++x)
                std::memcpy(pair->data(x + side * (a.s() + 8), y),
                            (side == 0 ? traced : rasterized).color->data(x, y), 3);
    osgDB::writeImageFile(*pair, std::string(folder) + "/" + name + ".png");
}

/// Draws a scene both ways and compares the pictures.
inline Comparison match(const std::string& name, osg::Node* model, const MatchSetup& setup = {},
                        Statistics* statistics = nullptr)
{
    const Picture traced = rayTrace(model, setup, statistics);
    const Picture rasterized = rasterize(model, setup);
    keepPictures(name, traced, rasterized);
    const Comparison comparison = compare(traced, rasterized);
    std::cout << name << ": mean difference " << comparison.difference << "/255 over "
              << comparison.both << " pixels of " << comparison.either << std::endl;
    return comparison;
}

} // namespace osgRayTrace::test
