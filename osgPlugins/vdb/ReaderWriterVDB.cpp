// ReaderWriterVDB.cpp - osgdb_vdb: OpenVDB's grids for every OSG program. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/OwnFolder.h"
#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/vdb/VdbOptions.h"
#include "osgPlugins/vdb/VolumeGraph.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <algorithm>
#include <istream>

namespace
{

using namespace osgRayTrace::vdb;

/// Returns all bytes of a stream. What does not begin as a file does is not read further.
std::string bytesOf(std::istream& stream)
{
    constexpr std::size_t kFirst = 4096, kLargest = std::size_t(1) << 26;
    std::string bytes;
    for (std::size_t block = kFirst; stream; block = std::min(bytes.size(), kLargest))
    {
        const std::size_t before = bytes.size();
        bytes.resize(before + block);
        stream.read(&bytes[before], static_cast<std::streamsize>(block));
        bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
        if (before == 0) checkMagic(bytes);
    }
    return bytes;
}

class ReaderWriterVDB : public osgDB::ReaderWriter
{
public:
    ReaderWriterVDB()
    {
        supportsExtension("vdb", "OpenVDB grids");
        supportsOption("grid=<name>", "The grid that is read. Default: density, else the first "
                                      "with numbers that have a fraction");
        supportsOption("maxVoxels=<number>",
                       "Larger grids are read with less resolution. Default: 134217728");
        supportsOption("extinction=<number>",
                       "Of a density of 1 [1/length]. Default: by the grid's own values");
        supportsOption("yUp", "Y is up in the file, and is turned to OSG's Z");
        osgRayTrace::engine::preferOwnFolder(); // for the plugin of PhysicalMaterial's serializer
    }

    const char* className() const override { return "OpenVDB Reader"; }

    ReadResult readObject(const std::string& file, const Options* options) const override
    {
        return readNode(file, options);
    }
    ReadResult readObject(std::istream& stream, const Options* options) const override
    {
        return readNode(stream, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;
        osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
        if (!stream) return ReadResult("vdb: '" + path + "': it cannot be opened");
        return readFrom(stream, "'" + path + "'", options);
    }

    ReadResult readNode(std::istream& stream, const Options* options) const override
    {
        return readFrom(stream, "stream", options);
    }

private:
    static ReadResult readFrom(std::istream& stream, const std::string& name,
                               const Options* options)
    {
        osg::ref_ptr<osg::Node> node;
        std::vector<std::string> notes;
        const std::string problem = osgRayTrace::engine::caught(
            [&]() -> std::string
            {
                const VdbOptions vdbOptions(options ? options->getOptionString() : "");
                node = readVolume(bytesOf(stream), vdbOptions, notes);
                return "";
            });
        if (!problem.empty()) return ReadResult("vdb: " + name + ": " + problem);
        for (const std::string& note : notes)
            OSG_NOTICE << "vdb: " << name << ": " << note << std::endl;
        return node.get();
    }

    static osg::ref_ptr<osg::Node> readVolume(const std::string& file, const VdbOptions& options,
                                              std::vector<std::string>& notes)
    {
        const std::vector<VdbEntry> entries = readEntries(file);
        const VdbEntry& entry = chosenEntry(entries, options.grid);
        VdbGrid grid = readGrid(file, entries, entry);
        if (options.yUp)
            grid.worldFromIndex.postMult(
                osg::Matrixd(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1));
        const VdbDense dense = readDense(file, grid, options.mostVoxels);
        const osg::ref_ptr<osg::Node> tile = volumeTile(dense, grid, options.extinction);
        tile->setName(printable(entry.name));
        if (dense.factor > 1)
            notes.push_back("a voxel is the mean of " + std::to_string(dense.factor) +
                            " along each side, for at most " + std::to_string(options.mostVoxels) +
                            " voxels (maxVoxels), and " + std::to_string(kMostCellSide) +
                            " along a side");
        if (dense.repaired > 0)
            notes.push_back(std::to_string(dense.repaired) +
                            " values are not finite or too large, and became the background");
        const std::string left = otherNames(entries, entry);
        if (!left.empty()) notes.push_back("grids that are not read: " + left);
        return tile;
    }
};

} // namespace

REGISTER_OSGPLUGIN(vdb, ReaderWriterVDB)
