// PhotonsModeTest.cpp - the measurements of osgraytracebench photons, with few photons and small
// pictures.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

#include <nlohmann/json.hpp>

#include <map>
#include <thread>

namespace
{

/// Returns the rows' values by name; a row that is not finite has no value.
std::map<std::string, double> rowsOf(const TemporaryFolder& folder, const std::string& arguments)
{
    const Outcome outcome = osgraytrace(folder, "photons --json rows.json " + arguments);
    CAPTURE(outcome.errors);
    REQUIRE(outcome.exitCode == 0);
    std::map<std::string, double> rows;
    const auto json = nlohmann::json::parse(contents(folder / "rows.json"));
    for (const auto& row : json.at("rows"))
    {
        const std::string name = row.at("name");
        CHECK(outcome.output.find(name) != std::string::npos);
        if (!row.at("value").is_null()) rows[name] = row.at("value");
    }
    return rows;
}

/// Returns the value of the last row whose name begins with begin and contains end.
double rowWith(const std::map<std::string, double>& rows, const std::string& begin,
               const std::string& end)
{
    CAPTURE(begin, end);
    int found = 0;
    double value = 0.0;
    for (const auto& [name, v] : rows)
        if (name.find(begin) == 0 && name.find(end) != std::string::npos)
        {
            ++found;
            value = v;
        }
    CHECK(found >= 1);
    return value;
}

const std::string kFew = "--runs 1 --photons 20000 ";

} // namespace

TEST_CASE("bench photons: the map finds what the plain grid does, and both are timed", "[apps]")
{
    const TemporaryFolder folder;
    const auto rows = rowsOf(folder, kFew + "--only lookup");
    for (const std::string radius : {"4.0", "2.3"})
    {
        // There are 20000 photons on the 1.9 million square millimetres of the box, on both sides.
        const double r = std::stod(radius);
        const double found = rowWith(rows, "lookup r " + radius, "photons found");
        CHECK(found > 20000.0 * 3.14 * r * r / 4.2e6);
        CHECK(found < 20000.0 * 3.14 * r * r / 1.0e6);
        for (const std::string name : {", 1 threads: plain grid", ", 1 threads: photon map"})
        {
            CHECK(rowWith(rows, "lookup r " + radius, name) > 0.0);
            CHECK(rowWith(rows, "build r " + radius, name) > 0.0);
        }
    }
}

TEST_CASE("bench photons: photons are traced beside bare rays", "[apps]")
{
    const TemporaryFolder folder;
    const auto rows = rowsOf(folder, kFew + "--only tracing");
    for (const std::string scene :
         {"box", "box with mirror", "box with glass", "caustics of glass"})
    {
        // The pass emits 5001 photons; photons for caustics end if they do not meet the glass.
        const double rays = 1e6 * rowWith(rows, "tracing, " + scene + ": rays of a pass", "");
        CHECK(rays > 5000.0);
        CHECK(rays < 5001.0 * 8.0);
        CHECK(rowWith(rows, "tracing, " + scene + ", 1 threads: bare", "") > 0.0);
        CHECK(rowWith(rows, "tracing, " + scene + ", 1 threads: photons", "") > 0.0);
    }
}

TEST_CASE("bench photons: error against time of all methods", "[apps]")
{
    const TemporaryFolder folder;
    const auto rows =
        rowsOf(folder, "--only error --width 16 --longest 0.125 --seeds 1 --reference-seconds 1");
    for (const std::string box : {"a", "b", "c"})
        for (const std::string method : {"PATH", "PPM", "SPPM", "PHOTON_CAUSTICS"})
        {
            // The error is that of one or a few passes.
            const double error = rowWith(rows, "error " + box + " " + method + " after", "");
            CHECK(error > 1e-5);
            CHECK(error < 1.0);
        }
}

TEST_CASE("bench photons: wrong usage is refused", "[apps]")
{
    const TemporaryFolder folder;
    for (const std::string arguments :
         {"--runs 0", "--photons 10", "--width -1", "--unknown", "--only nothing"})
        CHECK(osgraytrace(folder, "photons " + arguments).exitCode == 1);
    for (const std::string mode : {"report --quick", "limit", "interactive"})
        CHECK(osgraytrace(folder, mode + " --only nothing").exitCode == 1);
    // The program refuses before it measures for minutes.
    const Outcome unwritable = osgraytrace(folder, "limit --json nowhere/rows.json");
    CHECK(unwritable.exitCode == 4);
    CHECK(unwritable.errors ==
          "osgraytracebench: cannot write nowhere/rows.json: there is no folder nowhere\n");
    CHECK(osgraytrace(folder, "limit --json .").exitCode == 4);
    CHECK(folder.fileNames().empty());
}

TEST_CASE("bench photons: a signal leaves the rows that were measured", "[apps]")
{
    for (int milliseconds = 250; milliseconds < 20000; milliseconds *= 2)
    {
        const TemporaryFolder folder;
        RunningProgram program(folder / ".",
                               {OSGRAYTRACE_TEST_PROGRAM, "photons", "--width", "0", "--json",
                                "rows.json", "--runs", "50", "--photons", "20000"});
        REQUIRE(program.handles(SIGTERM));
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        program.signal(SIGTERM);
        CHECK(program.wait() == 143);
        if (folder.fileNames().empty()) continue; // the program had not begun yet
        CHECK(folder.fileNames() == std::vector<std::string>{"rows.json"});
        const auto json = nlohmann::json::parse(contents(folder / "rows.json"));
        CHECK(json.at("rows").size() > 0);
        CHECK(program.printed().find("osgraytracebench: SIGTERM: the rest was not measured") !=
              std::string::npos);
        return;
    }
    FAIL("it did not begin to measure within 20 s");
}

TEST_CASE("bench photons: a signal ends a row of minutes between two of its runs", "[apps]")
{
    const TemporaryFolder folder;
    RunningProgram program(folder / ".", {OSGRAYTRACE_TEST_PROGRAM, "photons", "--only", "lookup",
                                          "--runs", "1000", "--photons", "1000000"});
    REQUIRE(program.handles(SIGTERM));
    std::this_thread::sleep_for(std::chrono::seconds(2));
    program.signal(SIGTERM);
    const bool ended = program.prints("osgraytracebench: SIGTERM: ");
    CHECK(ended);
    if (!ended) program.signal(SIGKILL);
    CHECK(program.wait() == 143);
}

TEST_CASE("bench photons: what cannot be printed ends with 4", "[apps]")
{
    const TemporaryFolder folder;
    const Outcome outcome =
        osgraytrace(folder, "photons " + kFew + "--only lookup >/dev/full )", "(");
    CHECK(outcome.exitCode == 4);
    CHECK(outcome.errors.find("cannot write to standard output") != std::string::npos);
}
