// Output.cpp - files and standard output, with their errors. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Output.h"

#include "osgRayTrace/base/OutputFile.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>

namespace osgRayTrace::app
{

Failure cannotWrite(const std::string& path, const std::string& reason)
{
    return Failure(kCannotWrite, "cannot write " + path + ": " + reason);
}

void checkOutputs(const std::vector<Output>& outputs)
{
    for (const Output& output : outputs)
    {
        const std::string problem = engine::whyNotWritable(output.path);
        if (!problem.empty()) throw cannotWrite(output.path, problem);
        for (const Output& other : outputs)
        {
            if (&other == &output) break;
            if (!engine::isSameFile(output.path, other.path)) continue;
            throw Failure(kUsage, other.option + " " + other.path + " and " + output.option + " " +
                                      output.path + " are the same file");
        }
    }
}

void writeOutput(const std::string& path,
                 const std::function<void(const std::string& temporary)>& write)
{
    try
    {
        engine::writeFileWhole(path, write);
    }
    catch (const std::bad_alloc&)
    {
        throw cannotWrite(path, "there is not enough memory");
    }
    catch (const std::exception& problem)
    {
        throw cannotWrite(path, problem.what());
    }
}

void writeText(const std::string& path, const std::string& text)
{
    writeOutput(path,
                [&text](const std::string& file)
                {
                    std::ofstream stream(file, std::ios::binary);
                    stream << text;
                    stream.close();
                    if (!stream) throw std::runtime_error(std::strerror(errno));
                });
}

void checkStandardOutput()
{
    errno = 0;
    std::cout.flush();
    const bool flushed = std::fflush(stdout) == 0;
    if (flushed && std::cout && !std::ferror(stdout)) return;
    throw cannotWrite("to standard output", errno ? std::strerror(errno) : "a write failed");
}

} // namespace osgRayTrace::app
