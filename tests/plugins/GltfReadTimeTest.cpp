// GltfReadTimeTest.cpp - prints what reading a million triangles takes, as they stand and
// compressed; hidden: gltfTest "[.read-times]". Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfCompression.h"
#include "TemporaryFolder.h"
#include "tests/Catch.h"

#include <osgDB/ReadFile>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <malloc.h>

using namespace osgRayTrace::test;

namespace
{

constexpr int kCells = 707; ///< 2 * 707 * 707 triangles
constexpr int kRepeats = 9;

/// Returns the bytes of a data URI.
std::string fromBase64(const std::string& uri)
{
    static const std::string digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned int bits = 0, held = 0;
    for (std::size_t i = uri.find(',') + 1; i < uri.size() && uri[i] != '='; ++i)
    {
        bits = bits << 6 | static_cast<unsigned int>(digits.find(uri[i]));
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> held & 0xffu);
    }
    return bytes;
}

/// Takes the bytes away from views that no accessor has.
void emptyUnusedViews(Json& model)
{
    std::vector<bool> isUsed(model["bufferViews"].size(), false);
    for (const Json& accessor : model["accessors"])
        if (accessor.contains("bufferView")) isUsed.at(accessor["bufferView"]) = true;
    const Json& extensions = model["meshes"][0]["primitives"][0].value("extensions", Json());
    for (const Json& extension : extensions)
        isUsed.at(extension["bufferView"]) = true;
    for (std::size_t i = 0; i < isUsed.size(); ++i)
    {
        if (isUsed[i]) continue;
        Json& view = model["bufferViews"][i];
        model["buffers"][view["buffer"].get<std::size_t>()]["uri"] = "data:,";
        view["byteLength"] = 0;
    }
}

/// Returns the model as a .glb file: all buffers that have bytes become one.
std::string glbOf(Json model)
{
    emptyUnusedViews(model);
    struct Place
    {
        std::size_t buffer, offset;
    };
    std::string binary;
    std::vector<Place> places;
    Json buffers = Json::array({Json::object()});
    for (const Json& buffer : model["buffers"])
    {
        const bool hasBytes = buffer.contains("uri");
        places.push_back(hasBytes ? Place{0, binary.size()} : Place{buffers.size(), 0});
        if (!hasBytes) buffers.push_back(buffer);
        if (hasBytes) binary += fromBase64(buffer["uri"]);
        binary.resize((binary.size() + 3) / 4 * 4);
    }
    buffers[0]["byteLength"] = binary.size();
    const auto move = [&places](Json& part)
    {
        const Place& place = places.at(part["buffer"].get<std::size_t>());
        part["buffer"] = place.buffer;
        part["byteOffset"] = place.offset;
    };
    for (Json& view : model["bufferViews"])
    {
        move(view);
        if (view.contains("extensions")) move(view["extensions"]["EXT_meshopt_compression"]);
    }
    model["buffers"] = buffers;
    std::string text = model.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto chunk = [](const std::string& bytes, std::uint32_t type) {
        return bytesOf<std::uint32_t>({std::uint32_t(bytes.size()), type}) + bytes;
    };
    const std::string chunks = chunk(text, 0x4e4f534a) + chunk(binary, 0x004e4942);
    return bytesOf<std::uint32_t>({0x46546c67, 2, std::uint32_t(chunks.size()) + 12}) + chunks;
}

/// Returns the median time of some calls [ms].
double medianTime(const std::function<void()>& call)
{
    std::vector<double> times;
    for (int i = 0; i < kRepeats; ++i)
    {
        const auto begin = std::chrono::steady_clock::now();
        call();
        const std::chrono::duration<double, std::milli> time =
            std::chrono::steady_clock::now() - begin;
        times.push_back(time.count());
    }
    std::nth_element(times.begin(), times.begin() + kRepeats / 2, times.end());
    return times[kRepeats / 2];
}

/// Returns a number of /proc/self/status [KiB]; 0 where there is no such file.
long statusOf(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == name + ":")
        {
            long kibibytes = 0;
            status >> kibibytes;
            return kibibytes;
        }
    return 0;
}

/// Returns by how much the largest memory of a call is above that before it [MB].
double peakOf(const std::function<void()>& call)
{
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5; // begins a new peak
    const long before = statusOf("VmRSS");
    call();
    return static_cast<double>(statusOf("VmHWM") - before) * 1024e-6;
}

void measure(const char* name, const std::string& file)
{
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const auto size = static_cast<std::size_t>(stream.tellg());
    const auto readBytes = [&]
    {
        std::vector<char> bytes(size);
        stream.seekg(0).read(bytes.data(), static_cast<std::streamsize>(size));
        const std::vector<char> copied = bytes;
        REQUIRE(copied.size() == size);
    };
    const auto readScene = [&] { REQUIRE(osgDB::readRefNodeFile(file)); };
    readScene(); // the plugin is loaded
    const double peak = peakOf(readScene);
    std::printf("%-8s %5.1f MB: read %6.1f ms, bytes read and copied %6.1f ms, at most %+.1f MB\n",
                name, double(size) * 1e-6, medianTime(readScene), medianTime(readBytes), peak);
}

} // namespace

TEST_CASE("gltf: prints what reading a million triangles takes", "[.read-times]")
{
    const Grid grid = gridOf(kCells);
    const TemporaryFolder folder;
    const auto measureModel = [&](const char* name, const Json& model)
    {
        const std::string file = folder / (std::string(name) + ".glb");
        std::ofstream(file, std::ios::binary) << glbOf(model);
        measure(name, file);
    };
    measureModel("plain", plainModel(grid));
#ifdef OSGRAYTRACE_TEST_MESHOPT
    measureModel("meshopt", meshoptModel(grid, true));
#endif
#ifdef OSGRAYTRACE_TEST_DRACO
    measureModel("draco", dracoModel(grid, dracoBytes(grid, {14, true})));
    measureModel("draco 0", dracoModel(grid, dracoBytes(grid, {14, true, 0})));
#endif
}
