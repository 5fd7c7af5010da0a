// ReaderWriterGLTF.cpp - osgdb_gltf: glTF 2.0 models for every OSG program. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/OwnFolder.h"
#include "osgPlugins/gltf/Extensions.h"
#include "osgPlugins/gltf/SceneReader.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <exception>
#include <functional>
#include <iterator>
#include <new>

namespace
{

using namespace osgRayTrace::gltf;

class ReaderWriterGLTF : public osgDB::ReaderWriter
{
public:
    ReaderWriterGLTF()
    {
        supportsExtension("gltf", "glTF 2.0, with text and files beside it");
        supportsExtension("glb", "glTF 2.0 in one file");
        supportsOption("noRotation", "Y stays up, and is not turned to OSG's Z");
        supportsOption("scene=<index or name>", "The scene that is read. Default: the file's own");
        supportsOption("variant=<index or name>", "The variant of materials. Default: none");
        osgRayTrace::engine::preferOwnFolder(); // for the plugin of PhysicalMaterial's serializer
    }

    const char* className() const override { return "glTF Reader"; }

    ReadResult readObject(const std::string& file, const Options* options) const override
    {
        return readNode(file, options);
    }
    ReadResult readObject(std::istream& stream, const Options* options) const override
    {
        return readNode(stream, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;
        return readFrom("'" + path + "'",
                        [&] { return Document::openFile(path, GltfOptions(options)); });
    }

    /// Reads a stream. Files beside it are looked for in the first folder of the options.
    ReadResult readNode(std::istream& stream, const Options* options) const override
    {
        const bool hasFolder = options && !options->getDatabasePathList().empty();
        const std::string folder = hasFolder ? options->getDatabasePathList().front() : "";
        const auto open = [&]
        {
            std::string bytes{std::istreambuf_iterator<char>(stream), {}};
            return Document::openBytes(std::move(bytes), folder, GltfOptions(options));
        };
        return readFrom("stream", open);
    }

private:
    static ReadResult readFrom(const std::string& name, const std::function<Document()>& open)
    {
        try
        {
            Document document = open();
            checkExtensions(document);
            const osg::ref_ptr<osg::Node> scene = SceneReader(document).read();
            for (const std::string& note : document.notes())
                OSG_NOTICE << "gltf: " << name << ": " << note << std::endl;
            return scene.get();
        }
        catch (const std::bad_alloc&)
        {
            return ReadResult("gltf: " + name + ": there is not enough memory");
        }
        catch (const std::exception& error)
        {
            return ReadResult("gltf: " + name + ": " + error.what());
        }
    }
};

} // namespace

REGISTER_OSGPLUGIN(gltf, ReaderWriterGLTF)
