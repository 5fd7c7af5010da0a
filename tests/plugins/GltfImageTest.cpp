// GltfImageTest.cpp - image files beside a glTF model, which may be missing, foreign or hostile.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "TemporaryFolder.h"
#include "tests/Catch.h"

#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <sys/resource.h>

#include <filesystem>
#include <fstream>

using namespace osgRayTrace::test;

namespace
{

/// What became of an image of a model that must be read.
struct ReadImage
{
    osg::ref_ptr<const osg::Image> image;
    std::string notices;
};

/// Reads a model whose one texture has this image, from a stream with a folder.
ReadImage readImage(const std::string& folder, const std::string& uri,
                    osgDB::Options::CacheHintOptions caches = osgDB::Options::CACHE_NONE)
{
    Json model = triangleModel();
    model["images"] = {{{"uri", uri}}};
    model["textures"] = Json::parse(R"([{ "source": 0 }])");
    model["materials"] =
        Json::parse(R"([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }])");
    model["meshes"][0]["primitives"][0]["material"] = 0;
    attributesOf(model)["TEXCOORD_0"] =
        addAccessor<float>(model, {0, 0, 1, 0, 0, 1}, kFloat, "VEC2", 3);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(folder);
    options->setObjectCacheHint(caches);
    std::istringstream stream(model.dump());
    const Listening listening;
    auto result = gltfPlugin().readNode(stream, options.get());
    if (!result.validNode()) throw std::runtime_error(result.message());
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        geometryOf(*result.getNode())
            .getStateSet()
            ->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    return {texture->getImage(), listening.text()};
}

void writeBytes(const std::string& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary) << bytes;
}

/// Writes a red picture of so many pixels, all in one row.
void writePicture(const std::string& file, int width)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int x = 0; x < width; ++x)
        image->setColor(osg::Vec4(1, 0, 0, 1), static_cast<unsigned int>(x));
    if (!osgDB::writeImageFile(*image, file)) throw std::runtime_error("cannot write " + file);
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// Lets nothing be opened while it lives.
class NoMoreFiles
{
public:
    NoMoreFiles()
    {
        getrlimit(RLIMIT_NOFILE, &_before);
        const rlimit none = {0, _before.rlim_max};
        setrlimit(RLIMIT_NOFILE, &none);
    }
    ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &_before); }
    NoMoreFiles(const NoMoreFiles&) = delete;
    NoMoreFiles& operator=(const NoMoreFiles&) = delete;

private:
    rlimit _before = {};
};

} // namespace

TEST_CASE("gltf: an image file is PNG or JPEG, whatever its name says", "[gltf]")
{
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.tga", "a.bmp", "a.osgt"})
        writePicture(folder / name, 3);
    CHECK(readImage(folder / "", "a.png").image->s() == 3);

    for (const char* name : {"a.tga", "a.bmp", "a.osgt"})
    {
        INFO(name);
        const ReadImage other = readImage(folder / "", name);
        CHECK_FALSE(other.image->data());
        CHECK(has(other.image->getFileName(), name));
        CHECK(has(other.notices, "images[0].uri: is of a format that is not read"));
        // The plugin is chosen by what the file has.
        std::filesystem::copy_file(folder / "a.png", folder / name,
                                   std::filesystem::copy_options::overwrite_existing);
        const ReadImage renamed = readImage(folder / "", name);
        CHECK(renamed.image->s() == 3);
        CHECK(has(renamed.image->getFileName(), name));
        CHECK(renamed.notices.empty());
    }
}

TEST_CASE("gltf: models share the image files that osgDB caches", "[gltf]")
{
    const TemporaryFolder folder;
    writePicture(folder / "a.png", 3);
    const auto cached = osgDB::Options::CACHE_IMAGES;
    const auto first = readImage(folder / "", "a.png", cached).image;
    CHECK(first == readImage(folder / "", "a.png", cached).image);
    CHECK(first != readImage(folder / "", "a.png").image);
}

TEST_CASE("gltf: an image file that cannot be opened is reported, and the model is there", "[gltf]")
{
    const TemporaryFolder folder;
    writePicture(folder / "a.png", 3);
    readImage(folder / "", "a.png"); // loads the plugins
    ReadImage read;
    {
        const NoMoreFiles scarcity;
        read = readImage(folder / "", "a.png");
    }
    CHECK_FALSE(read.image->data());
    CHECK(has(read.image->getFileName(), "a.png"));
    CHECK(has(read.notices, "cannot be opened"));
    CHECK(has(readImage(folder / "", "b.png").notices, "no such file"));
}

TEST_CASE("gltf: the size of a JPEG image is the one that its decoder sees", "[gltf]")
{
    const TemporaryFolder folder;
    const std::string huge("\xff\xc0\0\x11\x08\xff\xff\xff\xff\x03\1\x11\0\2\x11\0\3\x11\0", 19);
    writeBytes(folder / "a.jpg", "\xff\xd8" + huge);
    CHECK(has(readImage(folder / "", "a.jpg").notices, "2^26 pixels"));
    writeBytes(folder / "a.jpg", "\xff\xd8\xff\x01\xff\xd0" + huge); // markers without a length
    CHECK(has(readImage(folder / "", "a.jpg").notices, "2^26 pixels"));
    writeBytes(folder / "a.jpg", "\xff\xd8\xff\xfe" + std::string("\0\2garbage", 9) + huge);
    CHECK(has(readImage(folder / "", "a.jpg").notices, "does not say its size"));
}

TEST_CASE("gltf: the image file that is looked at is the one that is read", "[gltf]")
{
    const TemporaryFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::create_directories(folder / "m/m");
    writePicture(folder / "m/a.png", 3);
    writePicture(folder / "m/m/a.png", 5); // osgDB would find it as m/a.png in the folder m
    std::filesystem::current_path(folder / "");
    const ReadImage read = readImage("m", "a.png");
    std::filesystem::current_path(before);
    CHECK(read.image->s() == 3);
}
