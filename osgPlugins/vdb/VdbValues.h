// VdbValues.h - the arrays of values that nodes have. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/vdb/VdbFile.h"

#include <vector>

namespace osgRayTrace::vdb
{

/// A bit for each value of a node, within the file.
class VdbMask
{
public:
    /// Reads the mask of a node; size: its number of values, a multiple of 64.
    VdbMask(VdbBytes& bytes, unsigned int size) : _bits(bytes.take(size / 8)), _size(size) {}

    bool operator[](unsigned int i) const { return _bits[i >> 3] >> (i & 7) & 1; }
    unsigned int size() const { return _size; }

    /// Returns the number of bits that are set.
    unsigned int count() const;

private:
    const unsigned char* _bits;
    unsigned int _size;
};

/// Reads and decompresses values of one tree. All functions throw a VdbError.
class VdbValues
{
public:
    explicit VdbValues(const VdbValueFormat& format) : _format(format) {}

    /// Reads a single value, which is never compressed.
    float single(VdbBytes& bytes) const;

    /// Sets the value of what no node has.
    void setBackground(float value) { _background = value; }

    /// Reads the values of a node, as many as the mask of its active ones has bits.
    void read(VdbBytes& bytes, const VdbMask& active, std::vector<float>& values);

private:
    const unsigned char* decompressed(VdbBytes& bytes, std::size_t length);

    VdbValueFormat _format;
    float _background = 0.0f;
    std::vector<unsigned char> _scratch;
};

} // namespace osgRayTrace::vdb
