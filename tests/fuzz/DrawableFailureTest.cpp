// DrawableFailureTest.cpp - allocations of a viewer's frame fail: the scene stays visible. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "tests/Catch.h"
#include "tests/gl/TestViewer.h"

#include <osg/Notify>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 24;
const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);

osg::Vec4 middle(const osg::Image& image)
{
    return pixel(image, kSize / 2, kSize / 2);
}

/// Lets the n-th allocation of one draw of the drawable fail.
struct FailingDraw : osg::Drawable::DrawCallback
{
    void drawImplementation(osg::RenderInfo& renderInfo,
                            const osg::Drawable* drawable) const override
    {
        if (n < 0)
        {
            drawable->drawImplementation(renderInfo);
            return;
        }
        const FailingMemory memory(n, failing);
        drawable->drawImplementation(renderInfo);
        failed = memory.failed();
        n = -1;
    }
    mutable int n = -1;
    Failing failing = Failing::Once;
    mutable bool failed = false;
};

} // namespace

TEST_CASE("stability 52: when an allocation of the conversion fails, a viewer shows the scene all "
          "the same",
          "[stability][fuzz][gl]")
{
    osg::setNotifyLevel(osg::FATAL);
    for (const Failing failing : {Failing::Once, Failing::Onward})
    {
        osg::ref_ptr<RayTracedScene> scene = tracedScene(unlitSquare(1.0f, kGreen).get());
        TestViewer view(kSize, kSize, scene.get());
        int failures = 0;
        for (int n = 0;; ++n)
        {
            CAPTURE(n, int(failing));
            // The failure is one of the drawable's first conversion, which has no earlier version
            // to fall back on.
            osg::ref_ptr<RayTracedScene> fresh = osg::clone(scene.get(), osg::CopyOp::SHALLOW_COPY);
            bool failed = false;
            {
                const FailingMemory memory(n, failing);
                fresh->getDrawable()->updateScene(nullptr);
                failed = memory.failed();
            }
            if (!failed) break;
            // Libraries go on without some allocations, such as buffers for a faster sort.
            const Statistics statistics = fresh->getDrawable()->getStatistics();
            REQUIRE(statistics.ok == statistics.message.empty());
            REQUIRE((statistics.triangles == 2u || !statistics.ok));
            failures += !statistics.ok;
            if (n % 8 != 0) continue; // a frame is slow
            view.viewer.setSceneData(fresh);
            REQUIRE(middle(*view.frames()) == osg::Vec4(0, 255, 0, 255));
        }
        CHECK(failures > 50);
    }
}

TEST_CASE("stability 52: when an allocation of a draw fails, the next frame shows the scene",
          "[stability][fuzz][gl]")
{
    osg::setNotifyLevel(osg::FATAL);
    for (const Failing failing : {Failing::Once, Failing::Onward})
    {
        osg::ref_ptr<RayTracedScene> scene = tracedScene(unlitSquare(1.0f, kGreen).get());
        scene->getSettings()->setMaxPasses(1);
        osg::ref_ptr<FailingDraw> callback = new FailingDraw;
        callback->failing = failing;
        scene->getDrawable()->setDrawCallback(callback);
        TestViewer view(kSize, kSize, scene.get());
        view.camera().setProjectionResizePolicy(osg::Camera::FIXED);
        view.frames(); // makes OpenGL's objects: OSG makes some of them in code that must not fail
        // The driver's compiler must not fail either when it compiles the shader for images of
        // another size.
        scene->getDrawable()->setPaused(true);
        view.camera().setViewport(0, 0, kSize - 2, kSize - 2);
        view.viewer.frame();
        scene->getDrawable()->setPaused(false);
        int failures = 0;
        for (int n = 0;; ++n)
        {
            CAPTURE(n, int(failing));
            const int size = kSize - 2 * (n % 3); // the display's images are made again
            view.camera().setViewport(0, 0, size, size);
            scene->setEnabled(true); // clears the former failure
            callback->n = n;
            callback->failed = false;
            view.viewer.frame();
            REQUIRE(callback->n == -1);
            if (!callback->failed) break;
            ++failures;
            const osg::ref_ptr<osg::Image> next = view.frames();
            REQUIRE(pixel(*next, size / 2, size / 2) == osg::Vec4(0, 255, 0, 255));
        }
        CHECK(failures > 5);
    }
}
