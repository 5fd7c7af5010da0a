// Program.h - runs osgraytrace as its users run it.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/plugins/TemporaryFolder.h"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

inline std::string contents(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

struct Outcome
{
    int exitCode = -1; ///< 124: the program did not end within a minute
    std::string output;
    std::string errors;
};

/// Runs osgraytrace in the folder. The shell splits the arguments; prefix goes before the program
/// ("NAME=value").
inline Outcome osgraytrace(const TemporaryFolder& folder, const std::string& arguments,
                           const std::string& prefix = "")
{
    const TemporaryFolder streams;
    const std::string command = "cd '" + folder / "." + "' && " + prefix + " timeout 60 '" +
                                OSGRAYTRACE_TEST_PROGRAM + "' " + arguments + " >'" +
                                streams / "out" + "' 2>'" + streams / "errors" + "' </dev/null";
    const int status = std::system(command.c_str());
    Outcome outcome;
    if (WIFEXITED(status)) outcome.exitCode = WEXITSTATUS(status);
    outcome.output = contents(streams / "out");
    outcome.errors = contents(streams / "errors");
    return outcome;
}

/// Returns the path of one of our scenes, quoted for the shell.
inline std::string dataFile(const std::string& name)
{
    return "'" OSGRAYTRACE_TEST_SOURCE "/data/" + name + "'";
}
