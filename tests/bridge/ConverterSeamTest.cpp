// ConverterSeamTest.cpp - a second thread in a SceneConverter ends the program. There are cases in
// builds with assertions alone.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#if defined(OSGRAYTRACE_ASSERTS)
#include "tests/ChildProcess.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/MaterialHook>

#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

TEST_CASE("a converter aborts when a second thread enters", "[bridge]")
{
    /// Uses the converter on another thread while it converts.
    struct Hook : MaterialHook
    {
        explicit Hook(SceneConverter& used) : converter(used) {}
        osg::ref_ptr<PhysicalMaterial>
        materialFor(const osg::NodePath&, const std::vector<const osg::StateSet*>&) override
        {
            if (enters) std::thread([this] { converter.releaseGraph(); }).join();
            return nullptr;
        }
        SceneConverter& converter;
        bool enters = false;
    };
    SceneConverter converter;
    const osg::ref_ptr<Hook> hook = new Hook(converter);
    const auto geometry = triangleGeometry();
    ConversionInput input = inputFor(geometry);
    input.hook = hook;
    CHECK_FALSE(test::isAborted([&] { converter.convert(input); }));
    hook->enters = true;
    CHECK(test::isAborted([&] { converter.convert(input); }));
}
#endif
