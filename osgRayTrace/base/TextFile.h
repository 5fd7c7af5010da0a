// TextFile.h - reads text files that a user names, which may have no end. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

namespace osgRayTrace::engine
{

struct FileText
{
    std::string text;
    std::string error; ///< such as "is a directory", to be said after the file's name; empty: none
};

/// Returns why a file cannot be read as one that has an end; empty if it can. Links are followed.
inline std::string irregularityOf(const std::string& file)
{
    std::error_code error;
    switch (std::filesystem::status(file, error).type())
    {
    case std::filesystem::file_type::regular:
        return "";
    case std::filesystem::file_type::not_found:
        return "there is no such file";
    case std::filesystem::file_type::directory:
        return "is a directory";
    case std::filesystem::file_type::fifo:
        return "is a pipe, as the shell's <(...) is: write to a file first";
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block:
        return "is a device";
    case std::filesystem::file_type::socket:
        return "is a socket";
    default:
        return "cannot be looked at: " + error.message();
    }
}

/// Returns the contents of a regular file, or of a link to one, of at most so many bytes.
inline FileText readTextFile(const std::string& file, std::size_t most)
{
    const std::string irregularity = irregularityOf(file);
    if (!irregularity.empty()) return {"", irregularity};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return {"", "cannot be opened"};
    FileText result;
    char buffer[4096];
    while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0)
    {
        result.text.append(buffer, static_cast<std::size_t>(stream.gcount()));
        if (result.text.size() > most)
            return {"", "has more than " + std::to_string(most) + " bytes"};
    }
    if (stream.bad()) return {"", "cannot be read"};
    return result;
}

} // namespace osgRayTrace::engine
