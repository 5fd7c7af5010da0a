// GltfFiles.h - small glTF models for tests, and the plugin that reads them. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgDB/Registry>

#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace osgRayTrace::test
{

using Json = nlohmann::json;

inline osgDB::ReaderWriter& gltfPlugin()
{
    osgDB::ReaderWriter* plugin = osgDB::Registry::instance()->getReaderWriterForExtension("gltf");
    if (!plugin) throw std::runtime_error("there is no plugin gltf");
    return *plugin;
}

inline osgDB::ReaderWriter::ReadResult readGltf(const std::string& bytes,
                                                const std::string& options = "")
{
    std::istringstream stream(bytes, std::ios::binary);
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(options);
    return gltfPlugin().readNode(stream, words.get());
}

/// Returns the scene of a model that must be read.
inline osg::ref_ptr<osg::Node> sceneOf(const Json& model, const std::string& options = "")
{
    osgDB::ReaderWriter::ReadResult result = readGltf(model.dump(), options);
    if (!result.validNode()) throw std::runtime_error(result.message());
    return result.getNode();
}

/// Returns why a model is refused; empty if it is not.
inline std::string refusalOf(const Json& model, const std::string& options = "")
{
    osgDB::ReaderWriter::ReadResult result = readGltf(model.dump(), options);
    return result.validNode() ? "" : result.message();
}

inline std::string base64(const std::string& bytes)
{
    const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        unsigned int bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits =
                bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63u];
    }
    return text;
}

template <typename T> std::string bytesOf(const std::vector<T>& values)
{
    std::string bytes(values.size() * sizeof(T), '\0');
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// Adds a buffer of these bytes with a view of all of it. Returns the number of the view.
inline int addView(Json& model, const std::string& bytes)
{
    const auto buffer = static_cast<int>(model["buffers"].size());
    model["buffers"].push_back({{"byteLength", bytes.size()},
                                {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    model["bufferViews"].push_back({{"buffer", buffer}, {"byteLength", bytes.size()}});
    return static_cast<int>(model["bufferViews"].size()) - 1;
}

/// Adds an accessor of values with a view of its own. Returns its number.
template <typename T>
int addAccessor(Json& model, const std::vector<T>& values, int componentType,
                const std::string& type, std::size_t count)
{
    const int view = addView(model, bytesOf(values));
    model["accessors"].push_back(
        {{"bufferView", view}, {"componentType", componentType}, {"type", type}, {"count", count}});
    return static_cast<int>(model["accessors"].size()) - 1;
}

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;

/// Returns a model of one node with one triangle: accessor 0 has its positions (0, 0, 0), (2, 0, 0)
/// and (0, 4, 0).
inline Json triangleModel()
{
    Json model = Json::parse(R"({
        "asset": { "version": "2.0" }, "buffers": [], "bufferViews": [], "accessors": [],
        "scenes": [{ "nodes": [0] }], "nodes": [{ "name": "first", "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }] })");
    addAccessor<float>(model, {0, 0, 0, 2, 0, 0, 0, 4, 0}, kFloat, "VEC3", 3);
    return model;
}

inline Json& attributesOf(Json& model)
{
    return model["meshes"][0]["primitives"][0]["attributes"];
}

/// Finds all nodes of a class.
template <typename NodeClass> std::vector<NodeClass*> findAll(osg::Node& scene)
{
    struct Find : osg::NodeVisitor
    {
        Find() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
        void apply(osg::Node& node) override
        {
            if (auto* one = dynamic_cast<NodeClass*>(&node)) found.push_back(one);
            traverse(node);
        }
        std::vector<NodeClass*> found;
    };
    Find find;
    scene.accept(find);
    return find.found;
}

inline osg::Geometry& geometryOf(osg::Node& scene, std::size_t number = 0)
{
    return *findAll<osg::Geometry>(scene).at(number);
}

template <typename ArrayType> const ArrayType& arrayOf(const osg::Array* array)
{
    const auto* typed = dynamic_cast<const ArrayType*>(array);
    if (!typed) throw std::runtime_error("the array is of another type");
    return *typed;
}

/// Collects what OSG would say.
class Notices : public osg::NotifyHandler
{
public:
    void notify(osg::NotifySeverity, const char* message) override { text += message; }

    std::string text;
};

/// Listens to OSG's notices while it lives.
class Listening
{
public:
    Listening() : _level(osg::getNotifyLevel()), _before(osg::getNotifyHandler())
    {
        osg::setNotifyLevel(osg::NOTICE);
        osg::setNotifyHandler(_notices.get());
    }
    ~Listening()
    {
        osg::setNotifyHandler(_before.get());
        osg::setNotifyLevel(_level);
    }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;

    const std::string& text() const { return _notices->text; }

private:
    osg::NotifySeverity _level;
    osg::ref_ptr<osg::NotifyHandler> _before;
    osg::ref_ptr<Notices> _notices = new Notices;
};

} // namespace osgRayTrace::test
