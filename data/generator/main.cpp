// main.cpp - osgraytrace_make_data FOLDER: writes our own scenes there as .osgt, and a sky.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Transport.h"

#include "apps/common/PluginPath.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Options>
#include <osgDB/WriteFile>

#include <iostream>
#include <string>

int main(int argc, char** argv)
{
    using namespace osgRayTrace::data;
    if (argc != 2)
    {
        std::cerr << "usage: osgraytrace_make_data FOLDER\n";
        return 1;
    }
    osgRayTrace::app::addPluginPath();

    struct File
    {
        const char* name;
        osg::ref_ptr<osg::Group> scene;
    };
    const File files[] = {
        {"cornell_box.osgt", cornellBox(CornellVariant::Diffuse)},
        {"cornell_box_mirror.osgt", cornellBox(CornellVariant::MirrorFloor)},
        {"cornell_box_tall_mirror.osgt", cornellBox(CornellVariant::TallMirror)},
        {"cornell_box_glass.osgt", cornellBox(CornellVariant::GlassSphere)},
        {"cornell_box_fog.osgt", cornellBox(CornellVariant::Fog)},
        {"drinks.osgt", drinks()},
        {"haze_window.osgt", hazeWindow()},
        {"glass_ball_fog.osgt", glassBallFog()},
        {"valley_fog.osgt", valleyFog()},
        {"grids.osgt", grids()},
        {"smoke.osgb", smoke()},
        {"wax.osgt", waxBust()},
        {"furnace.osgt", furnace()},
        {"rings.osgt", rings()},
        {"glasses.osgt", glasses()},
        {"prism.osgt", prism()},
        {"terrace.osgt", terrace()},
        {"ajar.osgt", ajar(0.08, false)},
        {"pool.osgt", pool(0.03)},
        {"necklace.osgt", necklace(0.2)},
        {"veach_plates.osgt", veachPlates(1.0)},
        {"veach_room.osgt", veachRoom(0.3)},
    };
    // Images are stored by their names.
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("WriteImageHint=UseExternal");
    const osg::ref_ptr<osgDB::Options> packed =
        new osgDB::Options("WriteImageHint=IncludeData Compressor=zlib");
    for (const File& file : files)
    {
        const std::string path = std::string(argv[1]) + "/" + file.name;
        // Volumes have their voxels within the file.
        const bool isBinary = osgDB::getFileExtension(path) == "osgb";
        if (osgDB::writeNodeFile(*file.scene, path, isBinary ? packed.get() : options.get()))
            continue;
        std::cerr << "osgraytrace_make_data: cannot write " << path << '\n';
        return 4;
    }
    const std::string wrong = writeSky(std::string(argv[1]) + "/sky.exr");
    if (!wrong.empty()) std::cerr << "osgraytrace_make_data: " << wrong << '\n';
    return wrong.empty() ? 0 : 4;
}
