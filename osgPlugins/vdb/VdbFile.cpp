// VdbFile.cpp - reads headers, metadata and transforms. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/VdbFile.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace osgRayTrace::vdb
{

namespace
{

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222, kNewestVersion = 225;
constexpr std::size_t kUuidLength = 36;
constexpr char kNameSuffix = '\x1e'; ///< stands before the number of grids of one name

/// Goes past metadata. Returns the text of the entry "class", in lower case.
std::string readMetadata(VdbBytes& bytes)
{
    std::string gridClass;
    const auto count = bytes.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const std::string name = bytes.text(), type = bytes.text();
        const auto length = bytes.number<std::uint32_t>();
        const unsigned char* value = bytes.take(length);
        if (name == "class" && type == "string")
            gridClass.assign(reinterpret_cast<const char*>(value), length);
    }
    std::transform(gridClass.begin(), gridClass.end(), gridClass.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return gridClass;
}

osg::Vec3d readVector(VdbBytes& bytes)
{
    const auto x = bytes.number<double>(), y = bytes.number<double>(), z = bytes.number<double>();
    return {x, y, z};
}

/// Reads a transform. Both OSG and OpenVDB multiply rows by matrices.
osg::Matrixd readTransform(VdbBytes& bytes)
{
    const std::string type = bytes.text();
    osg::Vec3d scale(1.0, 1.0, 1.0), translation;
    if (type == "AffineMap" || type == "UnitaryMap")
    {
        osg::Matrixd matrix;
        for (int k = 0; k < 16; ++k)
            matrix.ptr()[k] = bytes.number<double>();
        return matrix;
    }
    if (type == "TranslationMap" || type == "ScaleTranslateMap" ||
        type == "UniformScaleTranslateMap")
        translation = readVector(bytes);
    else if (type != "ScaleMap" && type != "UniformScaleMap")
        throw VdbError("its transform, a " + type + ", is not affine");
    if (type != "TranslationMap")
    {
        scale = readVector(bytes);
        constexpr std::uint64_t kDerived =
            4 * 3 * sizeof(double); // OpenVDB stores 1/scale and so on
        bytes.take(kDerived);
    }
    return osg::Matrixd::scale(scale) * osg::Matrixd::translate(translation);
}

bool isUsable(const osg::Matrixd& matrix)
{
    for (int k = 0; k < 16; ++k)
        if (!std::isfinite(matrix.ptr()[k])) return false;
    const osg::Vec3d x(matrix(0, 0), matrix(0, 1), matrix(0, 2)),
        y(matrix(1, 0), matrix(1, 1), matrix(1, 2)), z(matrix(2, 0), matrix(2, 1), matrix(2, 2));
    const double volume = std::fabs((x ^ y) * z);
    const bool affine =
        matrix(0, 3) == 0.0 && matrix(1, 3) == 0.0 && matrix(2, 3) == 0.0 && matrix(3, 3) == 1.0;
    return affine && volume > 1e-9 * x.length() * y.length() * z.length();
}

/// Returns what the values of a tree with the usual nodes, of 32, 16 and 8 parts along a side, are;
/// of others nothing.
std::string valueOfTree(const std::string& type)
{
    const std::string begin = "Tree_", end = "_5_4_3";
    if (type.size() <= begin.size() + end.size() || type.compare(0, begin.size(), begin) != 0 ||
        type.compare(type.size() - end.size(), end.size(), end) != 0)
        return "";
    return type.substr(begin.size(), type.size() - begin.size() - end.size());
}

} // namespace

bool VdbEntry::isScalar() const
{
    const std::string value = valueOfTree(type);
    return value == "float" || value == "double" || value == "half";
}

void checkMagic(const std::string& file)
{
    if (file.size() < sizeof kMagic || VdbBytes(file).number<std::int64_t>() != kMagic)
        throw VdbError("it is no OpenVDB file");
}

std::vector<VdbEntry> readEntries(const std::string& file)
{
    checkMagic(file);
    VdbBytes bytes(file);
    bytes.take(sizeof kMagic);
    const auto version = bytes.number<std::uint32_t>();
    if (version < kOldestVersion || version > kNewestVersion)
        throw VdbError("its format has version " + std::to_string(version) +
                       ", and those that are read are 222 to 225");
    bytes.take(2 * sizeof(std::uint32_t)); // the library's version
    if (bytes.number<std::uint8_t>() == 0)
        throw VdbError("it was written as a stream, without the places of its grids");
    bytes.take(kUuidLength);
    readMetadata(bytes);

    std::vector<VdbEntry> entries;
    const auto count = bytes.number<std::int32_t>();
    for (std::int32_t i = 0; i < count; ++i)
    {
        VdbEntry entry;
        entry.uniqueName = bytes.text();
        entry.name = entry.uniqueName.substr(0, entry.uniqueName.find(kNameSuffix));
        entry.type = bytes.text();
        const std::string halfSuffix = "_HalfFloat";
        const std::size_t suffix = entry.type.rfind(halfSuffix);
        entry.half = suffix != std::string::npos && suffix + halfSuffix.size() == entry.type.size();
        if (entry.half) entry.type.resize(suffix);
        entry.parent = bytes.text();
        entry.place = bytes.number<std::uint64_t>();
        bytes.take(sizeof(std::uint64_t)); // the place of the tree's values, which follow the tree
        const auto end = bytes.number<std::uint64_t>();
        entries.push_back(entry);
        if (end < bytes.place()) throw VdbError("the places of its grids are wrong");
        if (i + 1 < count) bytes = VdbBytes(file, end);
    }
    return entries;
}

VdbGrid readGrid(const std::string& file, const std::vector<VdbEntry>& entries,
                 const VdbEntry& entry)
{
    const auto readHead = [&file](const VdbEntry& of)
    {
        VdbGrid grid;
        VdbBytes bytes(file, of.place);
        grid.format.compression = bytes.number<std::uint32_t>();
        grid.isLevelSet = readMetadata(bytes) == "level set";
        grid.worldFromIndex = readTransform(bytes);
        grid.tree = bytes.place();
        const std::string value = valueOfTree(of.type);
        grid.format.bytes = value == "double" ? 8 : value == "half" ? 2 : 4;
        grid.format.half = of.half && value != "half";
        return grid;
    };
    VdbGrid grid = readHead(entry);
    if (!isUsable(grid.worldFromIndex)) throw VdbError("its transform is singular");
    if (entry.parent.empty()) return grid;

    const auto parent =
        std::find_if(entries.begin(), entries.end(),
                     [&entry](const VdbEntry& other)
                     { return other.uniqueName == entry.parent && other.parent.empty(); });
    if (parent == entries.end() || parent->type != entry.type)
        throw VdbError("the grid whose tree it shares is not there");
    const VdbGrid shared = readHead(*parent);
    grid.format = shared.format;
    grid.tree = shared.tree;
    return grid;
}

} // namespace osgRayTrace::vdb
