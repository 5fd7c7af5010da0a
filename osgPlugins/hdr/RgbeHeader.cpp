// RgbeHeader.cpp - variables and the resolution line. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/hdr/RgbeHeader.h"

#include <cmath>
#include <istream>
#include <locale>
#include <sstream>

namespace osgRayTrace::engine
{

namespace
{

// The format is that of "Radiance File Formats", radsite.lbl.gov: lines "#?RADIANCE", comments and
// variables NAME=value, then an empty line and the resolution. Variables that begin with a tab
// belong to pictures that this one was made from.

/// This limit counts all lines together. Radiance records every command that had to do with the
/// picture.
constexpr std::size_t kLongestHeader = std::size_t(1) << 20;

const char* const kTruncated = "the file ends within its header";

class HeaderReader
{
public:
    HeaderReader(std::istream& stream, RgbeHeader& header) : _stream(stream), _header(header) {}

    std::string read()
    {
        std::string text;
        char magic[2] = {};
        if (!_stream.read(magic, 2) || magic[0] != '#' || magic[1] != '?')
            return "this is no Radiance picture";
        for (bool first = true;; first = false)
        {
            const std::string problem = line(text);
            if (!problem.empty()) return problem;
            if (first) continue; // the name of a program
            if (text.empty()) break;
            const std::string bad = variable(text);
            if (!bad.empty()) return bad;
        }
        const std::string problem = line(text);
        return problem.empty() ? resolution(text) : problem;
    }

private:
    std::string line(std::string& text)
    {
        text.clear();
        for (char c = 0; _stream.get(c);)
        {
            if (c == '\n')
            {
                if (!text.empty() && text.back() == '\r') text.pop_back();
                return "";
            }
            if (++_length > kLongestHeader) return "its header has no end";
            text += c;
        }
        return kTruncated;
    }

    std::string variable(const std::string& text)
    {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos) return "";
        const std::string name = text.substr(0, equals);
        std::istringstream values(text.substr(equals + 1));
        values.imbue(std::locale::classic());
        if (name == "FORMAT")
        {
            std::string format;
            values >> format;
            _header.image.xyz = format == "32-bit_rle_xyze";
            if (format != "32-bit_rle_rgbe" && !_header.image.xyz)
                return "its format '" + format.substr(0, 80) + "' is none of Radiance's";
        }
        else if (name == "EXPOSURE")
        {
            double factor = 0;
            if (!positive(values, factor)) return "its EXPOSURE is no positive number";
            for (double& each : _header.image.factors)
                each *= factor;
        }
        else if (name == "COLORCORR")
        {
            for (double& each : _header.image.factors)
            {
                double factor = 0;
                if (!positive(values, factor)) return "its COLORCORR is not three positive numbers";
                each *= factor;
            }
        }
        else if (name == "GAMMA" && !positive(values, _header.image.gamma))
            return "its GAMMA is no positive number";
        return "";
    }

    static bool positive(std::istream& values, double& value)
    {
        constexpr double kLargest = 1e30;
        values >> value;
        return values && value >= 1 / kLargest && value <= kLargest;
    }

    /// Reads "-Y 512 +X 1024": the axis of the lines, and the axis within a line.
    std::string resolution(const std::string& text)
    {
        std::istringstream values(text);
        values.imbue(std::locale::classic());
        std::string axes[2], rest;
        long long sizes[2] = {};
        values >> axes[0] >> sizes[0] >> axes[1] >> sizes[1];
        const auto isAxis = [](const std::string& axis)
        {
            return axis.size() == 2 && (axis[0] == '+' || axis[0] == '-') &&
                   (axis[1] == 'X' || axis[1] == 'Y');
        };
        if (!values || values >> rest || !isAxis(axes[0]) || !isAxis(axes[1]) ||
            axes[0][1] == axes[1][1])
            return "its line of the resolution is not understood";
        RgbeOrder& order = _header.order;
        order.columns = axes[0][1] == 'X';
        const long long width = sizes[order.columns ? 0 : 1], height = sizes[order.columns ? 1 : 0];
        if (!isRgbeSize(width, height))
            return "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels is empty or too large";
        // X grows to the right and Y upwards.
        order.linesFromEnd = axes[0][0] == '-';
        order.pixelsFromEnd = axes[1][0] == '-';
        order.lines = static_cast<int>(sizes[0]);
        order.length = static_cast<int>(sizes[1]);
        _header.image.width = static_cast<int>(width);
        _header.image.height = static_cast<int>(height);
        return "";
    }

    std::istream& _stream;
    RgbeHeader& _header;
    std::size_t _length = 0;
};

} // namespace

std::string readRgbeHeader(std::istream& stream, RgbeHeader& header)
{
    header = {};
    std::string problem = HeaderReader(stream, header).read();
    if (!problem.empty()) return problem;
    for (const double factor : header.image.factors)
        if (!(factor > 1e-30 && factor < 1e30)) return "its EXPOSURE and COLORCORR are absurd";
    return "";
}

} // namespace osgRayTrace::engine
