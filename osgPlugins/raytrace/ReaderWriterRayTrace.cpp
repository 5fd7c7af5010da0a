// ReaderWriterRayTrace.cpp - pseudo-loader: model.osgt.raytrace is ray traced. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "Parameters.h"

#include "osgPlugins/OwnFolder.h"

#include <osgRayTrace/RayTracedScene>

#include <osgDB/FileNameUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <exception>

/// Reads FILE[.PARAMETERS].raytrace: the scene of FILE below an osgRayTrace::RayTracedScene. FILE
/// is read with the caller's options and may be a pseudo-loader's name itself. Parameters may be:
///   cow.osgt.raytrace                              settings from the environment
///   cow.osgt.path.raytrace                         an integrator, or a debug channel
///   "cow.osgt.(integrator=path,passes=64).raytrace"  options by name
///   "cow.osgt.(environment=sky.exr,sun=180:40).raytrace"  lights by SceneLights' names
class ReaderWriterRayTrace : public osgDB::ReaderWriter
{
public:
    ReaderWriterRayTrace()
    {
        supportsExtension("raytrace", "Ray tracing pseudo-loader");
        osgRayTrace::engine::preferOwnFolder(); // for the images of the file's scene
    }

    const char* className() const override { return "ray tracing pseudo-loader"; }

    ReadResult readObject(const std::string& fileName,
                          const osgDB::ReaderWriter::Options* options) const override
    {
        return readNode(fileName, options);
    }

    ReadResult readNode(const std::string& fileName,
                        const osgDB::ReaderWriter::Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName)))
            return ReadResult::FILE_NOT_HANDLED;
        try
        {
            return readRayTraced(osgDB::getNameLessExtension(fileName), options);
        }
        catch (const std::exception& error)
        {
            return ReadResult(std::string("raytrace: ") + error.what());
        }
    }

private:
    /// Reads a scene. name: without ".raytrace".
    static ReadResult readRayTraced(const std::string& name,
                                    const osgDB::ReaderWriter::Options* options)
    {
        const NameParts parts = splitName(name);
        if (parts.file.empty()) return ReadResult("raytrace: the name of the model is missing");

        const osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
        osgRayTrace::SceneLights lights;
        lights.readVariables();
        const std::string error = applyParameters(parts.parameters, *scene->getSettings(), lights);
        if (!error.empty()) return ReadResult("raytrace: " + error);

        const osg::ref_ptr<Options> naming = options ? options->cloneOptions() : new Options;
        naming->setPluginStringData("ForceReadingImage",
                                    "true"); // keeps the names of images that are missing
        ReadResult read = osgDB::Registry::instance()->readNode(parts.file, naming.get());
        if (!read.validNode()) return failure(read, parts.file);
        scene->addChild(read.getNode());
        const std::string problem = lights.addTo(*scene);
        if (!problem.empty()) return ReadResult("raytrace: " + problem);
        return scene;
    }

    /// Returns the reader's own status, so that a missing file is a missing file; never a success.
    static ReadResult failure(ReadResult read, const std::string& file)
    {
        if (read.success()) return ReadResult("raytrace: " + file + " holds no scene");
        if (read.message().empty()) read.message() = file;
        return read;
    }
};

REGISTER_OSGPLUGIN(raytrace, ReaderWriterRayTrace)
