// VdbOptions.cpp - reads options and chooses a grid. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/VdbOptions.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <sstream>

namespace osgRayTrace::vdb
{

namespace
{

constexpr std::size_t kNamesShown = 16;

double positive(const std::string& key, const std::string& text)
{
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value) || !stream.eof() || !(value > 0.0) || !std::isfinite(value))
        throw VdbError("the option " + key + " is no number above 0");
    return value;
}

std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string described(const VdbEntry& entry)
{
    return printable(entry.name) + " (" + printable(entry.type) + ")";
}

} // namespace

VdbOptions::VdbOptions(const std::string& words)
{
    std::istringstream stream(words);
    for (std::string word; stream >> word;)
    {
        const std::size_t equals = word.find('=');
        const std::string key = word.substr(0, equals);
        const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
        if (key == "grid") grid = value;
        if (key == "maxVoxels")
            mostVoxels = static_cast<std::uint64_t>(std::clamp(positive(key, value), 1.0, 1e15));
        if (key == "extinction") extinction = positive(key, value);
        if (word == "yUp") yUp = true;
    }
}

const VdbEntry& chosenEntry(const std::vector<VdbEntry>& entries, const std::string& name)
{
    if (entries.empty()) throw VdbError("it has no grids");
    const auto first = [&entries](const auto& isIt)
    {
        const auto found = std::find_if(entries.begin(), entries.end(), isIt);
        return found == entries.end() ? nullptr : &*found;
    };
    const VdbEntry none;
    if (!name.empty())
    {
        const VdbEntry* entry = first([&](const VdbEntry& e) { return e.name == name; });
        if (!entry)
            throw VdbError("it has no grid '" + name + "', but " + otherNames(entries, none));
        if (!entry->isScalar())
            throw VdbError("its grid " + described(*entry) + " is not of float, double or half");
        return *entry;
    }
    const VdbEntry* entry =
        first([](const VdbEntry& e) { return e.isScalar() && lowerCase(e.name) == "density"; });
    if (!entry) entry = first([](const VdbEntry& e) { return e.isScalar(); });
    if (!entry)
        throw VdbError("it has no grid of float, double or half, but " + otherNames(entries, none));
    return *entry;
}

std::string otherNames(const std::vector<VdbEntry>& entries, const VdbEntry& chosen)
{
    std::string names;
    std::size_t count = 0;
    for (const VdbEntry& entry : entries)
    {
        if (&entry == &chosen) continue;
        if (count++ < kNamesShown) names += (names.empty() ? "" : ", ") + described(entry);
    }
    if (count > kNamesShown) names += " and " + std::to_string(count - kNamesShown) + " others";
    return names;
}

std::string printable(const std::string& text)
{
    constexpr std::size_t kLongest = 60;
    std::string result = text.substr(0, kLongest);
    std::replace_if(
        result.begin(), result.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return result;
}

} // namespace osgRayTrace::vdb
