// CullView.h - a view of content before a wall, whose traced picture is compared with OSG's own.
// Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/Program>

#include <functional>
#include <string>

namespace osgRayTrace::test
{

constexpr int kViewSize = 128;
const osg::Vec4 kRed(0.9f, 0.2f, 0.1f, 1.0f), kBlue(0.1f, 0.3f, 0.9f, 1.0f);

using Setup = std::function<void(TestViewer&)>;

/// Holds a viewer of content before a traced wall.
struct View
{
    explicit View(osg::Node* content, const Setup& setup = {})
        : root(new osg::Group),
          scene(tracedScene(root.get())),
          viewer(kViewSize, kViewSize, scene.get())
    {
        root->addChild(unlitSquare(2.5f, osg::Vec4(0.1f, 0.5f, 0.2f, 1.0f)));
        if (content) root->addChild(content);
        viewer.look(osg::Vec3d(1.0, -2.0, 8.0));
        viewer.viewer.realize();
        if (setup) setup(viewer);
    }

    uint64_t count(const std::string& what)
    {
        return scene->getDrawable()->getStatistics().conversion[what];
    }
    uint64_t conversions() { return scene->getDrawable()->getStatistics().conversions; }

    osg::ref_ptr<osg::Group> root;
    osg::ref_ptr<RayTracedScene> scene;
    TestViewer viewer;
};

/// Checks that the view shows after so many frames what OSG alone shows, where the content is seen.
inline void checkPicture(View& view, const Setup& setup = {}, int frames = 2)
{
    View bare(nullptr, setup);
    const osg::ref_ptr<osg::Image> traced = view.viewer.frames(frames);
    view.scene->setEnabled(false);
    const osg::ref_ptr<osg::Image> wanted = view.viewer.frames(2);
    view.scene->setEnabled(true);
    bare.scene->setEnabled(false);
    const osg::ref_ptr<osg::Image> wall = bare.viewer.frames(2);
    long pixels = 0;
    const auto changed = [&](int x, int y) { return pixel(*wanted, x, y) != pixel(*wall, x, y); };
    for (int y = 0; y < kViewSize; ++y)
        for (int x = 0; x < kViewSize; ++x)
            pixels += changed(x, y) ? 1 : 0;
    const double difference = meanDifference(*traced, *wanted, changed);
    const double shown = meanDifference(*wall, *wanted, changed);
    CAPTURE(difference, shown, pixels);
    CHECK(pixels > 200);
    CHECK(difference < 0.06 * shown); // edges of what is traced are smooth
}

inline osg::ref_ptr<osg::Geometry> plainSquare(float half)
{
    osg::ref_ptr<osg::Geometry> square = unlitSquare(half, osg::Vec4(1, 1, 1, 1));
    square->setStateSet(nullptr);
    return square;
}

inline void addProgram(osg::Node& node)
{
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(0.9, 0.1, 0.9, 1.0); }"));
    node.getOrCreateStateSet()->setAttributeAndModes(program.get());
}

} // namespace osgRayTrace::test
