// TaggedWords.cpp - finds and writes what begins words. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "TaggedWords.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <cstring>
#include <limits>
#include <locale>
#include <sstream>

namespace
{

/// Gives access to a stream's iterator, which osgDB shows to derived classes alone.
struct OpenStream : osgDB::InputStream
{
    static std::istream& bytesOf(osgDB::InputStream& stream)
    {
        return *(stream.*(&OpenStream::_in))->getStream();
    }
};

/// Returns whether a binary stream goes on with the tag; the stream stays where it is.
bool isNext(osgDB::InputStream& stream, std::string_view tag)
{
    std::istream& bytes = OpenStream::bytesOf(stream);
    const std::istream::pos_type here = bytes.tellg();
    const std::size_t lengthBytes = 4;
    std::vector<char> next(lengthBytes + tag.size());
    bytes.read(next.data(), static_cast<std::streamsize>(next.size()));
    const bool found =
        bytes.good() && std::memcmp(next.data() + lengthBytes, tag.data(), tag.size()) == 0;
    bytes.clear();
    bytes.seekg(here);
    return found;
}

} // namespace

std::string wordOfNumbers(std::initializer_list<float> values)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(std::numeric_limits<float>::max_digits10);
    for (const float value : values)
        text << (text.tellp() > 0 ? "," : "") << value;
    return text.str();
}

std::vector<float> valuesOf(const std::string& word, std::size_t count)
{
    std::istringstream text(word);
    text.imbue(std::locale::classic());
    std::vector<float> values;
    float value = 0.0f;
    while (text >> value)
    {
        values.push_back(value);
        text.ignore(1, ',');
    }
    values.resize(count, 0.0f);
    return values;
}

bool readsTag(osgDB::InputStream& stream, const std::string& property, std::string_view tag)
{
    if (!stream.isBinary()) return stream.matchString(property);
    if (!isNext(stream, tag)) return false;
    std::string name;
    stream >> name;
    return true;
}

Words readWords(osgDB::InputStream& stream)
{
    const unsigned int count = stream.readSize();
    stream >> stream.BEGIN_BRACKET;
    Words words;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        std::string name, word;
        stream >> name >> word;
        if (!stream.getException()) words.emplace_back(std::move(name), std::move(word));
    }
    return words;
}

void writeWords(osgDB::OutputStream& stream, const std::string& property, std::string_view tag,
                const Words& words)
{
    if (stream.isBinary())
        stream << std::string(tag);
    else
        stream << stream.PROPERTY(property.c_str());
    stream.writeSize(words.size());
    stream << stream.BEGIN_BRACKET << std::endl;
    for (const auto& [name, word] : words)
        stream << name << word << std::endl;
}
