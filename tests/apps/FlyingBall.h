// FlyingBall.h - an animated model, and where a picture shows what moves in it.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osg/AnimationPath>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

/// The arguments of a quick picture of the model.
inline const std::string kQuickBall = "ball.osgt --size 64 16 --passes 2 ";

/// Writes ball.osgt: a ball that flies along x over a box around the origin. places: pairs of a
/// time [s] and x, between which the ball flies evenly; it rests after the last one. depth: of the
/// box, along y.
inline void writeBall(const TemporaryFolder& folder,
                      const std::vector<std::pair<double, double>>& places, float depth)
{
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->setLoopMode(osg::AnimationPath::NO_LOOPING);
    for (const auto& [time, x] : places)
        path->insert(time, osg::AnimationPath::ControlPoint({x, 0.0, 0.0}));
    osg::ref_ptr<osg::MatrixTransform> ball = new osg::MatrixTransform;
    ball->setUpdateCallback(new osg::AnimationPathCallback(path));
    ball->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f)));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(ball);
    root->addChild(new osg::ShapeDrawable(new osg::Box({0.0f, 0.0f, -2.0f}, 12.0f, depth, 1.0f)));
    REQUIRE(osgDB::writeNodeFile(*root, folder / "ball.osgt"));
}

/// Where the ball is, in the upper half of a picture, and over how many columns.
struct SeenBall
{
    double column = 0.0; ///< the mean of those that show it
    int columns = 0;
};

/// Returns the place of what is not the background in the upper half of a picture.
inline SeenBall ballIn(const std::string& file)
{
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file);
    REQUIRE(picture);
    SeenBall seen;
    for (int x = 0; x < picture->s(); ++x)
    {
        bool isHere = false;
        for (int y = picture->t() / 2; y < picture->t() && !isHere; ++y)
            isHere = std::abs(picture->getColor(unsigned(x), unsigned(y)).r() - 0.2f) > 0.02f;
        seen.column += isHere ? x : 0.0;
        seen.columns += isHere;
    }
    REQUIRE(seen.columns > 0);
    seen.column /= seen.columns;
    return seen;
}
