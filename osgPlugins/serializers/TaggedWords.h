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

/// Reads the words behind what readsTag() has found, and leaves the stream before the bracket that
/// closes them. If the stream fails they are those before.
Words readWords(osgDB::InputStream& stream);

/// Writes words that readsTag() finds and readWords() reads. The caller closes their bracket.
void writeWords(osgDB::OutputStream& stream, const std::string& property, std::string_view tag,
                const Words& words);
