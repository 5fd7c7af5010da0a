// ReportReasonsTest.cpp - the keys of the report in the sources, in their table and in the
// documentation. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/bridge/common/ReportReasons.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

using namespace osgRayTrace::engine;

namespace
{

const std::filesystem::path kLibrary =
    std::filesystem::path(OSGRAYTRACE_TEST_SOURCE) / "osgRayTrace";

std::string textOf(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    REQUIRE(stream);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Whatever has the form of a key between these two.
void addKeys(std::set<std::string>& keys, const std::string& text, const std::string& before,
             const std::string& after)
{
    std::string classes = "instance";
    for (const ReportClass& c : kReportClasses)
        classes += "|" + std::string(c.prefix, std::string(c.prefix).size() - 1);
    const std::regex key(before + "((?:" + classes + ")\\.[a-z][a-z0-9-]*)" + after);
    for (std::sregex_iterator i(text.begin(), text.end(), key), end; i != end; ++i)
        keys.insert((*i)[1]);
}

std::set<std::string> keysOfTable()
{
    std::set<std::string> keys;
    for (const ReportReason& reason : kReportReasons)
        CHECK(keys.insert(reason.key).second); // each is there once
    return keys;
}

std::set<std::string> keysOfSources()
{
    std::set<std::string> keys;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kLibrary / "bridge"))
        if (entry.is_regular_file() && entry.path().filename() != "ReportReasons.h")
            addKeys(keys, textOf(entry.path()), "\"", "\"");
    return keys;
}

} // namespace

TEST_CASE("report reasons: the sources use the keys of the table, and no others", "[bridge]")
{
    CHECK(keysOfSources() == keysOfTable());
}

TEST_CASE("report reasons: the documentation has each key with its meaning, and no others",
          "[bridge]")
{
    const std::string page = textOf(kLibrary / "docs" / "coverage.md");
    std::set<std::string> keys;
    addKeys(keys, page, "\\b", "");
    CHECK(keys == keysOfTable());
    for (const ReportReason& reason : kReportReasons)
    {
        INFO(reason.key);
        const std::string row = "| `" + std::string(reason.key) + "` | " + reason.meaning + " |\n";
        CHECK(page.find(row) != std::string::npos);
    }
}

TEST_CASE("report reasons: each key but one has a class that the report names", "[bridge]")
{
    for (const ReportReason& reason : kReportReasons)
    {
        INFO(reason.key);
        const auto has = [&reason](const ReportClass& c)
        { return std::string(reason.key).rfind(c.prefix, 0) == 0; };
        const bool other = std::string(reason.key) == "instance.invalid-transform";
        CHECK(std::count_if(std::begin(kReportClasses), std::end(kReportClasses), has) == !other);
    }
}
