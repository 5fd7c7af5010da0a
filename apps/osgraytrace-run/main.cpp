// main.cpp - osgraytrace-run: starts a foreign program with its scenes ray traced. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/ErrorLine.h"
#include "osgRayTrace/base/Platform.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>

using osgRayTrace::app::printError;

namespace
{

constexpr const char* kProgram = "osgraytrace-run";
constexpr int kUsage = 1, kNoLibrary = 2, kCannotWrite = 4;
constexpr int kCannotStart = 127; // code of shells

constexpr long kMostPasses = 1 << 24;

constexpr const char* kHelp =
    "Usage: osgraytrace-run [--passes N] [--report FILE] PROGRAM [ARGUMENTS...]\n"
    "       osgraytrace-run --version\n"
    "Starts an OpenSceneGraph program that knows nothing of osgRayTrace with its scenes ray "
    "traced.\n"
    "\n"
    "  --passes N, --max-passes N  passes at most, as OSGRAYTRACE_MAX_PASSES=N\n"
    "  --report FILE               writes to FILE, when PROGRAM ends, what was ray traced and\n"
    "                              what was left to OSG; as OSGRAYTRACE_RUN_REPORT=FILE\n"
    "\n"
    "Environment:\n"
    "  OSGRAYTRACE_...         settings: osgraytrace --list-options names each one's variable\n"
    "  OSGRAYTRACE_ENVIRONMENT, OSGRAYTRACE_SUN=AZIMUTH:ELEVATION, OSGRAYTRACE_HEADLIGHT=on|off\n"
    "                          lights, as osgraytrace's options of these names\n"
    "  OSGRAYTRACE_TOGGLE_KEY  key that switches ray tracing off and on: F1 to F12, or a character "
    "(F9)\n"
    "\n"
    "Limitations: what views show is ray traced, by osgViewer's View::setSceneData. Cameras with "
    "scenes of\n"
    "their own and scenes drawn by osgUtil::SceneView stay OSG's, as do programs that hold an "
    "OSG of their own.\n"
    "\n"
    "Exit code: that of PROGRAM; 1 usage, 2 our library is missing, 4 this cannot be printed,\n"
    "127 PROGRAM cannot be started.\n";

std::optional<std::filesystem::path> ourLibrary()
{
    std::error_code error;
    const std::filesystem::path program = osgRayTrace::engine::programPath();
    constexpr const char* kFolders[] = {OSGRAYTRACE_LIBRARIES_FROM_PROGRAMS "/osgRayTrace",
                                        OSGRAYTRACE_LIBRARIES_FROM_PROGRAMS, "../lib"};
    for (const char* folder : kFolders)
    {
        const auto library =
            (program.parent_path() / folder / OSGRAYTRACE_RUN_LIBRARY).lexically_normal();
        if (std::filesystem::exists(library, error)) return library;
    }
    return std::nullopt;
}

void prepend(const char* variable, const std::string& value, char separator)
{
    const char* before = std::getenv(variable);
    const std::string list = before && *before ? value + separator + before : value;
    setenv(variable, list.c_str(), 1);
}

bool isPasses(const char* argument)
{
    return !std::strcmp(argument, "--passes") || !std::strcmp(argument, "--max-passes");
}

bool isReport(const char* argument)
{
    return !std::strcmp(argument, "--report");
}

bool setPasses(const char* option, const char* value)
{
    const std::size_t digits = std::strspn(value, "0123456789");
    const long passes = digits < 9 ? std::strtol(value, nullptr, 10) : 0;
    if (value[digits] != '\0' || passes < 1 || passes > kMostPasses)
    {
        printError(kProgram, std::string(option) + ' ' + value + ": the values are 1 .. " +
                                 std::to_string(kMostPasses));
        return false;
    }
    setenv("OSGRAYTRACE_MAX_PASSES", value, 1);
    return true;
}

/// Names the file of the report, which PROGRAM may write from another folder; an older report does
/// not stay.
void reportTo(const char* file)
{
    std::error_code error;
    const std::filesystem::path path = std::filesystem::absolute(file, error);
    if (std::filesystem::is_regular_file(path, error)) std::filesystem::remove(path, error);
    setenv("OSGRAYTRACE_RUN_REPORT", path.c_str(), 1);
}

} // namespace

int main(int argc, char** argv)
{
    const bool help = argc > 1 && (!std::strcmp(argv[1], "--help") || !std::strcmp(argv[1], "-h"));
    if (argc == 2 && !std::strcmp(argv[1], "--version"))
    {
        std::cout << "osgraytrace-run " OSGRAYTRACE_PROJECT_VERSION << std::endl;
        return std::cout ? 0 : kCannotWrite;
    }
    int first = 1;
    for (; first + 1 < argc && (isPasses(argv[first]) || isReport(argv[first])); first += 2)
    {
        if (isReport(argv[first]))
            reportTo(argv[first + 1]);
        else if (!setPasses(argv[first], argv[first + 1]))
            return kUsage;
    }
    if (argc <= first || help)
    {
        (help ? std::cout : std::cerr) << kHelp << std::flush;
        if (!std::cout) return kCannotWrite;
        return help ? 0 : kUsage;
    }
    const auto library = ourLibrary();
    if (!library)
    {
        printError(kProgram, OSGRAYTRACE_RUN_LIBRARY " is not where this program is installed");
        return kNoLibrary;
    }
    prepend("LD_PRELOAD", library->string(), ':');
    prepend("OSG_LIBRARY_PATH", library->parent_path().string(),
            ':'); // models may hold our materials
    execvp(argv[first], argv + first);
    printError(kProgram, std::string("cannot start ") + argv[first] + ": " + std::strerror(errno));
    return kCannotStart;
}
