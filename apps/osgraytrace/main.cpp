// main.cpp - osgraytrace: ray traces models to files, without any OpenGL context. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Run.h"
#include "apps/common/ErrorLine.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Output.h"
#include "apps/common/PluginPath.h"
#include "apps/common/Program.h"
#include "apps/common/SceneNames.h"
#include "apps/group/Launcher.h"

#include <osgRayTrace/MaterialFile>

#include <iostream>
#include <optional>

namespace osgRayTrace::app
{

namespace
{

/// Writes the materials of the models as a file to edit.
void writeMaterials(const Options& options)
{
    checkOutputs({{"--write-materials", options.writtenMaterials}});
    const MaterialFile file = materialFileOf(*readScene(options.models));
    writeText(options.writtenMaterials, file.text);
    std::cout << options.writtenMaterials << ": " << file.entries << " entries" << std::endl;
    if (file.nameless > 0)
        printError(kProgram, std::to_string(file.nameless) +
                                 " geometries are in no entry: neither material nor texture nor a "
                                 "node of theirs alone has a name");
    if (!file.complete)
        printError(kProgram, "the models are too large or too deep; materials of some parts are "
                             "left out");
}

int runCommandLine(int argc, char** argv)
{
    addPluginPath(); // a backdrop may be an image of our plugins
    const std::optional<Options> options = parseOptions(argc, argv);
    if (!options) return kDone;
    if (options->listOptions)
    {
        std::cout << optionTable();
        return kDone;
    }
    if (!options->merged.empty()) return runMerge(*options);
    if (options->names)
    {
        std::cout << namesOf(*readScene(options->models)) << std::flush;
        return kDone;
    }
    if (!options->writtenMaterials.empty())
    {
        writeMaterials(*options);
        return kDone;
    }
    if (options->mpi) return runInGroup(*options);
    checkMaterials(*options);
    const std::string alone = whyNotAlone();
    if (!alone.empty()) throw Failure(kUsage, alone);
    return options->frames ? runFrames(*options) : runPicture(*options);
}

} // namespace

} // namespace osgRayTrace::app

int main(int argc, char** argv)
{
    using namespace osgRayTrace::app;
    return runProgram(kProgram, [=] { return runCommandLine(argc, argv); });
}
