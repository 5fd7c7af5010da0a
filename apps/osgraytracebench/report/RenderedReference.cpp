// RenderedReference.cpp - renders references, and keeps them in a cache. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Reference.h"

#include "apps/common/Failure.h"
#include "apps/common/Output.h"
#include "osgRayTrace/base/TextFile.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace osgRayTrace::bench
{

using nlohmann::ordered_json;

namespace
{

constexpr uint32_t kFirstSeed = 0x5eed0000u; ///< the report's pictures have small seeds

std::string hexadecimal(uint64_t value)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

bool readValues(std::ifstream& stream, std::vector<double>& values, std::size_t count)
{
    values.resize(count);
    stream.read(reinterpret_cast<char*>(values.data()),
                static_cast<std::streamsize>(count * sizeof(double)));
    return static_cast<bool>(stream);
}

/// Reads a cached reference; returns false if the file is not there, is damaged, or is of another
/// scene or plan.
bool readCached(const std::string& stem, const ordered_json& wanted, Reference& reference)
{
    for (const char* ending : {".json", ".f64"})
        if (!engine::irregularityOf(stem + ending).empty()) return false;
    std::ifstream text(stem + ".json"), values(stem + ".f64", std::ios::binary);
    if (!text || !values) return false;
    const ordered_json found = ordered_json::parse(text, nullptr, false);
    if (!found.is_object()) return false;
    for (const auto& [key, value] : wanted.items())
    {
        if (!found.contains(key) || found[key] != value) return false;
    }
    const std::size_t count = 3 * static_cast<std::size_t>(reference.width) * reference.height;
    if (!readValues(values, reference.mean, count) ||
        !readValues(values, reference.variance, count))
        return false;
    reference.origin = found.value("origin", "cached");
    return true;
}

void writeCached(const std::string& stem, const ordered_json& description,
                 const Reference& reference)
{
    std::filesystem::create_directories(std::filesystem::path(stem).parent_path());
    std::string values;
    for (const std::vector<double>* list : {&reference.mean, &reference.variance})
        values.append(reinterpret_cast<const char*>(list->data()), list->size() * sizeof(double));
    app::writeText(stem + ".f64", values);
    app::writeText(stem + ".json",
                   description.dump(2) + "\n"); // last: it vouches for the .f64
}

/// Sets the mean of the pictures, and the variance of that mean from their scatter.
int renderSeeds(const ReportScene& scene, const PreparedScene& prepared, const ReferencePlan& plan,
                Reference& reference)
{
    const std::size_t count = 3 * static_cast<std::size_t>(reference.width) * reference.height;
    reference.mean.assign(count, 0.0);
    std::vector<double> squares(count, 0.0);
    int passes = plan.passes;
    for (int seed = 0; seed < plan.seeds; ++seed)
    {
        const auto session =
            newSession(prepared, scene.reference, kFirstSeed + static_cast<uint32_t>(seed));
        engine::StopRule rule;
        if (passes > 0)
            rule.passes = passes;
        else
            rule.seconds = plan.seconds;
        passes = renderOn(*session, rule).passes;
        const Pixels pixels = pixelsOf(*session);
        for (std::size_t i = 0; i < count; ++i)
        {
            const double delta = static_cast<double>(pixels.rgb[i]) - reference.mean[i];
            reference.mean[i] += delta / (seed + 1.0);
            squares[i] += delta * (static_cast<double>(pixels.rgb[i]) - reference.mean[i]);
        }
    }
    reference.variance.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        reference.variance[i] = squares[i] / (plan.seeds * (plan.seeds - 1.0));
    return passes;
}

} // namespace

Reference renderedReference(const ReportScene& scene, const PreparedScene& prepared,
                            const ReferencePlan& plan, const std::string& folder)
{
    Reference reference;
    reference.width = prepared.view.width;
    reference.height = prepared.view.height;
    ordered_json description{{"hash", hexadecimal(hashOf(prepared, scene.reference))},
                             {"first_seed", kFirstSeed},
                             {"seeds", plan.seeds},
                             {"planned_passes", plan.passes},
                             {"planned_seconds", plan.seconds}};
    const std::string stem =
        folder + "/references/" + scene.name + "-" + std::to_string(reference.width);
    if (!readCached(stem, description, reference))
    {
        const int passes = renderSeeds(scene, prepared, plan, reference);
        reference.origin = scene.reference.name + ", " + std::to_string(plan.seeds) + " seeds of " +
                           std::to_string(passes) + " passes";
        double variance = 0.0;
        for (const double value : reference.variance)
            variance += value / static_cast<double>(reference.variance.size());
        description["passes"] = passes;
        description["mean_variance"] = variance;
        description["origin"] = reference.origin;
        writeCached(stem, description, reference);
    }
    finish(reference);
    return reference;
}

Reference newReference(const ReportScene& scene, const PreparedScene& prepared,
                       const ReferencePlan& plan)
{
    // The folder is its own, and removed: nothing is found in it.
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("osgraytracebench-" + scene.name);
    std::filesystem::remove_all(folder);
    const Reference reference = renderedReference(scene, prepared, plan, folder.string());
    std::filesystem::remove_all(folder);
    return reference;
}

double noiseOf(const Reference& reference, double floor)
{
    double noise = 0.0;
    for (std::size_t i = 0; i < reference.mean.size(); ++i)
        noise += reference.variance[i] / (reference.mean[i] * reference.mean[i] + floor * floor);
    return noise / static_cast<double>(reference.mean.size());
}

} // namespace osgRayTrace::bench
