// PseudoLoaderTest.cpp - "model.osgt.raytrace" and its parameters.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

using osgRayTrace::RayTracedScene;
using osgRayTrace::RayTraceSettings;
using Result = osgDB::ReaderWriter::ReadResult;

namespace
{

/// Holds a folder with a model, which exists while the object lives.
class Folder
{
public:
    Folder()
    {
        const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
        _path = std::filesystem::temp_directory_path() /
                ("osgraytrace (" + std::to_string(now) + ").d");
        std::filesystem::create_directories(_path);
        const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->setName("quad");
        geode->addDrawable(osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1.0f, 0.0f, 0.0f),
                                                           osg::Vec3(0.0f, 1.0f, 0.0f)));
        REQUIRE(osgDB::writeNodeFile(*geode, file("quad.osgt")));
    }
    ~Folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }
    std::string file(const std::string& name) const { return (_path / name).string(); }
    std::string path() const { return _path.string(); }

private:
    std::filesystem::path _path;
};

Result readNode(const std::string& name, const osgDB::Options* options = nullptr)
{
    return osgDB::Registry::instance()->readNode(name, options);
}

osg::ref_ptr<RayTracedScene> readScene(const std::string& name)
{
    INFO(name);
    Result result = readNode(name);
    INFO(result.statusMessage());
    osg::ref_ptr<RayTracedScene> scene = dynamic_cast<RayTracedScene*>(result.getNode());
    REQUIRE(scene);
    return scene;
}

} // namespace

TEST_CASE("pseudo-loader: a model comes back below a RayTracedScene", "[plugins]")
{
    const Folder folder;
    const auto scene = readScene(folder.file("quad.osgt.raytrace"));
    REQUIRE(scene->getNumChildren() == 1);
    CHECK(scene->getChild(0)->getName() == "quad");
    CHECK(scene->getEnabled());
    for (const auto& option : RayTraceSettings::options())
    {
        CHECK(scene->getSettings()->get(option.name) == option.defaultValue);
    }
}

TEST_CASE("pseudo-loader: a word is an integrator or a debug channel", "[plugins]")
{
    const Folder folder;
    const auto path = readScene(folder.file("quad.osgt.path.raytrace"));
    CHECK(path->getNumChildren() == 1);
    CHECK(path->getSettings()->getIntegrator() == RayTraceSettings::PATH);
    const auto whitted = readScene(folder.file("quad.osgt.Whitted.raytrace"));
    CHECK(whitted->getSettings()->getIntegrator() == RayTraceSettings::WHITTED);
    const auto albedo = readScene(folder.file("quad.osgt.albedo.raytrace"));
    CHECK(albedo->getSettings()->getIntegrator() == RayTraceSettings::DEBUG);
    CHECK(albedo->getSettings()->getDebugChannel() == RayTraceSettings::ALBEDO);
}

TEST_CASE("pseudo-loader: options are set by name, with or without brackets", "[plugins]")
{
    const Folder folder;
    for (const char* parameters :
         {"(integrator=path,passes=64)", "[path,maxPasses=64]", "path,max_passes=64",
          "(integrator = path , max-passes = 64)", "integrator=path,passes=64"})
    {
        INFO(parameters);
        const auto scene =
            readScene(folder.file(std::string("quad.osgt.") + parameters + ".raytrace"));
        CHECK(scene->getNumChildren() == 1);
        CHECK(scene->getSettings()->getIntegrator() == RayTraceSettings::PATH);
        CHECK(scene->getSettings()->getMaxPasses() == 64);
    }
    const auto exposed =
        readScene(folder.file("quad.osgt.(exposure=-1.5,light-sampling=random).raytrace"));
    CHECK(exposed->getSettings()->getExposure() == -1.5f);
    CHECK(exposed->getSettings()->getLightSampling() == RayTraceSettings::RANDOM);
    CHECK(readScene(folder.file("quad.osgt.().raytrace"))->getNumChildren() == 1);
}

TEST_CASE("pseudo-loader: lights are added by osgraytrace's names", "[plugins]")
{
    const Folder folder;
    const auto scene = readScene(folder.file("quad.osgt.(sun=90:30,path).raytrace"));
    REQUIRE(scene->getNumChildren() == 2);
    CHECK(scene->getChild(0)->getName() == "quad");
    const auto* source = dynamic_cast<osg::LightSource*>(scene->getChild(1));
    REQUIRE(source);
    CHECK(source->getLight()->getPosition().x() == Approx(std::sqrt(0.75)));
    CHECK(source->getLight()->getPosition().z() == Approx(0.5));
    CHECK(scene->getSettings()->getIntegrator() == RayTraceSettings::PATH);

    const auto dark = readScene(folder.file("quad.osgt.(headlight=off).raytrace"));
    CHECK(dark->getNumChildren() == 1);
    CHECK(dark->getStateSet()->getMode(GL_LIGHT0) == osg::StateAttribute::OFF);
    for (const char* wrong : {"sun=90", "sun=0:91", "headlight=maybe", "environment-strength=0",
                              "environment=no-such-sky.exr"})
    {
        INFO(wrong);
        CHECK_FALSE(
            readNode(folder.file(std::string("quad.osgt.(") + wrong + ").raytrace")).success());
    }

    setenv("OSGRAYTRACE_SUN", "0:90", 1); // as for programs under osgraytrace-run
    CHECK(readScene(folder.file("quad.osgt.raytrace"))->getNumChildren() == 2);
    unsetenv("OSGRAYTRACE_SUN");
    CHECK(readScene(folder.file("quad.osgt.raytrace"))->getNumChildren() == 1);
}

TEST_CASE("pseudo-loader: it nests with OSG's own, either way round", "[plugins]")
{
    const Folder folder;
    const auto outside = readScene(folder.file("quad.osgt.90,0,0.rot.raytrace"));
    REQUIRE(outside->getNumChildren() == 1);
    CHECK(dynamic_cast<osg::MatrixTransform*>(outside->getChild(0)) != nullptr);

    const auto both = readScene(folder.file("quad.osgt.(90,0,0).rot.path.raytrace"));
    CHECK(both->getSettings()->getIntegrator() == RayTraceSettings::PATH);
    CHECK(dynamic_cast<osg::MatrixTransform*>(both->getChild(0)) != nullptr);

    Result result = readNode(folder.file("quad.osgt.path.raytrace.90,0,0.rot"));
    auto* rotated = dynamic_cast<osg::MatrixTransform*>(result.getNode());
    REQUIRE(rotated);
    const auto* inside = dynamic_cast<RayTracedScene*>(rotated->getChild(0));
    REQUIRE(inside);
    CHECK(inside->getSettings()->getIntegrator() == RayTraceSettings::PATH);
}

TEST_CASE("pseudo-loader: what does not fit is named, and nothing is loaded", "[plugins]")
{
    const Folder folder;
    const auto messageOf = [&folder](const std::string& parameters)
    {
        Result result = readNode(folder.file("quad.osgt." + parameters + ".raytrace"));
        CHECK_FALSE(result.validNode());
        CHECK(result.status() == Result::ERROR_IN_READING_FILE);
        return result.message();
    };
    using Catch::Matchers::Contains;
    CHECK_THAT(messageOf("(wave-length=3)"), Contains("wave-length"));
    CHECK_THAT(messageOf("(light-samples=many)"), Contains("many") && Contains("1 .. 4096"));
    CHECK_THAT(messageOf("light-samples=0"), Contains("light-samples"));
    CHECK_THAT(messageOf("(photons)"), Contains("photons"));
    CHECK_THAT(messageOf("(path,,passes=4)"), Contains("''"));
}

TEST_CASE("pseudo-loader: a file that is missing is not found", "[plugins]")
{
    const Folder folder;
    Result missing = readNode(folder.file("nothing.osgt.raytrace"));
    CHECK_FALSE(missing.validNode());
    CHECK(missing.status() == Result::FILE_NOT_FOUND);
    Result withParameters = readNode(folder.file("nothing.osgt.(path).raytrace"));
    CHECK(withParameters.status() == Result::FILE_NOT_FOUND);

    CHECK_FALSE(readNode(".raytrace").validNode());
    CHECK_FALSE(readNode("raytrace").validNode());
    CHECK_FALSE(readNode(folder.file(".raytrace")).validNode());
    CHECK_FALSE(readNode(folder.file("(path).raytrace")).validNode());
    CHECK_FALSE(readNode(folder.file("quad.osgt.))((.raytrace")).validNode());
}

TEST_CASE("pseudo-loader: a file that is cut short is an error", "[plugins]")
{
    const Folder folder;
    std::ifstream whole(folder.file("quad.osgt"));
    const std::string text((std::istreambuf_iterator<char>(whole)),
                           std::istreambuf_iterator<char>());
    const auto cut = text.find("VertexArray");
    REQUIRE(cut != std::string::npos);
    std::ofstream(folder.file("cut.osgt")) << text.substr(0, cut);

    Result result = readNode(folder.file("cut.osgt.raytrace"));
    CHECK_FALSE(result.validNode());
    CHECK(result.status() == Result::ERROR_IN_READING_FILE);
    CHECK_FALSE(result.message().empty());
}

TEST_CASE("pseudo-loader: the model is found along the caller's database path", "[plugins]")
{
    const Folder folder;
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    CHECK_FALSE(readNode("quad.osgt.raytrace", options).validNode());
    options->getDatabasePathList().push_back(folder.path());
    Result result = readNode("quad.osgt.path.raytrace", options);
    REQUIRE(dynamic_cast<RayTracedScene*>(result.getNode()) != nullptr);
}

TEST_CASE("pseudo-loader: what it reads can be written and read again", "[plugins]")
{
    const Folder folder;
    const auto scene = readScene(folder.file("quad.osgt.(path,passes=64).raytrace"));
    REQUIRE(osgDB::writeNodeFile(*scene, folder.file("traced.osgt")));
    const auto again = readScene(folder.file("traced.osgt"));
    REQUIRE(again->getNumChildren() == 1);
    CHECK(again->getChild(0)->getName() == "quad");
    CHECK(again->getSettings()->getIntegrator() == RayTraceSettings::PATH);
    CHECK(again->getSettings()->getMaxPasses() == 64);
}
