// Program.h - runs osgraytrace as its users do.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/plugins/TemporaryFolder.h"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

inline std::string contents(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

struct Outcome
{
    int exitCode = -1; ///< 124: did not end within a minute
    std::string output;
    std::string errors;
};

/// Arguments are split by the shell; prefix goes before the program ("NAME=value").
inline Outcome osgraytrace(const std::filesystem::path& folder, const std::string& arguments,
                           const std::string& prefix = "")
{
    const std::filesystem::path output = folder / "stdout.txt";
    const std::filesystem::path errors = folder / "stderr.txt";
    const std::string command = "cd '" + folder.string() + "' && " + prefix + " timeout 60 '" OSGRAYTRACE_TEST_PROGRAM "' " +
                                arguments + " >'" + output.string() + "' 2>'" + errors.string() + "' </dev/null";
    const int status = std::system(command.c_str());
    Outcome outcome;
    if (WIFEXITED(status)) outcome.exitCode = WEXITSTATUS(status);
    outcome.output = contents(output);
    outcome.errors = contents(errors);
    std::filesystem::remove(output);
    std::filesystem::remove(errors);
    return outcome;
}

/// Names of all files in the folder, sorted.
inline std::vector<std::string> filesIn(const std::filesystem::path& folder)
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// A scene of ours, quoted for the shell.
inline std::string dataFile(const std::string& name)
{
    return "'" OSGRAYTRACE_TEST_SOURCE "/data/" + name + "'";
}
