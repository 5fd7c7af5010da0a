// Uri.cpp - decodes URIs, and keeps them in the folder of their file. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Uri.h"

#include <array>
#include <cctype>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::size_t kLongestPath = 4096;
constexpr int kNoDigit = -1;

std::array<signed char, 256> base64Digits()
{
    std::array<signed char, 256> digits;
    digits.fill(kNoDigit);
    const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < alphabet.size(); ++i)
        digits[static_cast<unsigned char>(alphabet[i])] = static_cast<signed char>(i);
    return digits;
}

int hexDigit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return kNoDigit;
}

std::string percentDecoded(const JsonPlace& place)
{
    const std::string& uri = place.text();
    std::string path;
    for (std::size_t i = 0; i < uri.size(); ++i)
    {
        if (uri[i] != '%')
        {
            path += uri[i];
            continue;
        }
        const int high = i + 2 < uri.size() ? hexDigit(uri[i + 1]) : kNoDigit;
        const int low = i + 2 < uri.size() ? hexDigit(uri[i + 2]) : kNoDigit;
        if (high < 0 || low < 0) place.refuse("has a '%' without two hexadecimal digits");
        path += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return path;
}

/// Returns whether a path begins as "http:" or "C:" does.
bool hasScheme(const std::string& path)
{
    const std::size_t end = path.find_first_of(":/");
    return end != std::string::npos && path[end] == ':';
}

bool goesUp(const std::string& path)
{
    std::size_t begin = 0;
    while (begin <= path.size())
    {
        std::size_t end = path.find('/', begin);
        if (end == std::string::npos) end = path.size();
        if (path.compare(begin, end - begin, "..") == 0) return true;
        begin = end + 1;
    }
    return false;
}

} // namespace

bool isDataUri(const std::string& uri)
{
    return uri.rfind("data:", 0) == 0;
}

std::string bytesOfDataUri(const JsonPlace& place)
{
    static const std::array<signed char, 256> digits = base64Digits();
    const std::string& uri = place.text();
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || comma < 7 || uri.compare(comma - 7, 7, ";base64") != 0)
        place.refuse("is a data URI without ';base64,'");

    std::size_t end = uri.size();
    while (end > comma + 1 && uri[end - 1] == '=')
        --end;
    const std::size_t count = end - comma - 1;
    if (count % 4 == 1) place.refuse("is base64 of an impossible length");
    std::string bytes;
    bytes.reserve(count / 4 * 3 + 2);
    unsigned int bits = 0;
    int held = 0;
    for (std::size_t i = comma + 1; i < end; ++i)
    {
        const int digit = digits[static_cast<unsigned char>(uri[i])];
        if (digit < 0) place.refuse("has a character that is not of base64");
        bits = (bits << 6 | static_cast<unsigned int>(digit)) & 0xffffffu;
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> held & 0xffu);
    }
    return bytes;
}

std::string pathOfUri(const JsonPlace& place)
{
    const std::string path = percentDecoded(place);
    if (path.empty()) place.refuse("is empty");
    if (path.size() > kLongestPath) place.refuse("is longer than 4096 bytes");
    for (const char c : path)
        if (static_cast<unsigned char>(c) < 32 || c == '\\')
            place.refuse("has a backslash or a control character");
    if (hasScheme(path))
        place.refuse("'" + path + "' has a scheme; files beside the model are read");
    if (path[0] == '/' || goesUp(path))
        place.refuse("'" + path + "' leaves the folder of the model");
    return path;
}

} // namespace osgRayTrace::gltf
