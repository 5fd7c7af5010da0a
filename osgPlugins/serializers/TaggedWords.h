// TaggedWords.h - values as names and words, which may be missing in files of before. Layer:
// plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgDB
{
class InputStream;
class OutputStream;
} // namespace osgDB

/// Names and what they say, in order.
using Words = std::vector<std::pair<std::string, std::string>>;

/// Returns the text of numbers, from which valuesOf() makes the same numbers in any locale.
std::string wordOfNumbers(std::initializer_list<float> values);

/// Returns the first numbers of a word; what is missing is 0.
std::vector<float> valuesOf(const std::string& word, std::size_t count);

/// Returns whether a stream goes on with words of wrapper's own. Text files begin them with the
/// property's name; binary files, which have no names, with the tag. Without them the stream stays
/// where it is.
bool readsTag(osgDB::InputStream& stream, const std::string& property, std::string_view tag);

/// Begins words that readsTag() finds.
void writeTag(osgDB::OutputStream& stream, const std::string& property, std::string_view tag);
