// ClassicLocale.cpp - a serializer around another one. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>
#include <osgDB/Serializer>

#include <locale>

namespace
{

/// Holds the locale that exchangeLocale gives to the stream, and then the stream's own:
/// manipulators have no arguments.
thread_local std::locale* otherLocale = nullptr;

std::ios_base& exchangeLocale(std::ios_base& stream)
{
    *otherLocale = stream.imbue(*otherLocale);
    return stream;
}

/// Gives access to a stream's iterator, which osgDB shows to derived classes alone.
struct OpenStream : osgDB::OutputStream
{
    static std::ios_base& textOf(osgDB::OutputStream& stream)
    {
        return *(stream.*(&OpenStream::_out))->getStream();
    }
};

/// Gives the stream that writes numbers another locale; returns the one it had. In XML that stream
/// is osgDB's own, which manipulators reach; elsewhere a manipulator would write an indentation.
std::locale setLocale(osgDB::OutputStream& stream, const std::locale& locale)
{
    const osgDB::Options* options = stream.getOptions();
    const bool xml = options && options->getPluginStringData("fileType") == "XML";
    if (!xml) return OpenStream::textOf(stream).imbue(locale);
    std::locale exchanged = locale;
    otherLocale = &exchanged;
    stream << exchangeLocale;
    return exchanged;
}

class ClassicLocaleSerializer : public osgDB::BaseSerializer
{
public:
    explicit ClassicLocaleSerializer(osgDB::BaseSerializer* serializer)
        : osgDB::BaseSerializer(serializer->getUsage()), _serializer(serializer)
    {
    }

    bool set(osg::Object& object, void* value) override { return _serializer->set(object, value); }
    bool get(const osg::Object& object, void* value) override
    {
        return _serializer->get(object, value);
    }
    /// Reads without a change of locale: readers take a point in any locale.
    bool read(osgDB::InputStream& stream, osg::Object& object) override
    {
        return _serializer->read(stream, object);
    }
    const std::string& getName() const override { return _serializer->getName(); }
    osgDB::IntLookup* getIntLookup() override { return _serializer->getIntLookup(); }

    /// Writes in the classic locale. Serializers of inner objects come through here again, while
    /// the locale is the classic one.
    bool write(osgDB::OutputStream& stream, const osg::Object& object) override
    {
        const std::locale before = setLocale(stream, std::locale::classic());
        const bool written = _serializer->write(stream, object);
        setLocale(stream, before);
        return written;
    }

private:
    osg::ref_ptr<osgDB::BaseSerializer> _serializer;
};

} // namespace

void writeInClassicLocale(osgDB::ObjectWrapper& wrapper)
{
    for (osg::ref_ptr<osgDB::BaseSerializer>& serializer : wrapper.getSerializerList())
        serializer = new ClassicLocaleSerializer(serializer.get());
}
