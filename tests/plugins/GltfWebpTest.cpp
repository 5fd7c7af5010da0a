// GltfWebpTest.cpp - textures in WebP have the pixels of the picture, and damaged ones are named.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfCompression.h"
#include "TemporaryFolder.h"
#include "tests/Catch.h"

#include <osg/Texture2D>

#include <cstring>
#include <filesystem>
#include <fstream>

#ifdef OSGRAYTRACE_TEST_WEBP
using namespace osgRayTrace::test;

namespace
{

/// Returns the image of the texture of a triangle with this image object.
osg::ref_ptr<const osg::Image> imageOf(Json model, const Json& image,
                                       const std::string& folder = "")
{
    model["extensionsUsed"] = {"EXT_texture_webp"};
    model["images"] = Json::array({image});
    model["textures"] =
        Json::parse(R"([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }])");
    model["materials"] =
        Json::parse(R"([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }])");
    model["meshes"][0]["primitives"][0]["material"] = 0;
    attributesOf(model)["TEXCOORD_0"] =
        addAccessor<float>(model, {0, 0, 1, 0, 0, 1}, kFloat, "VEC2", 3);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    if (!folder.empty()) options->getDatabasePathList().push_back(folder);
    std::istringstream stream(model.dump());
    auto result = gltfPlugin().readNode(stream, options.get());
    if (!result.validNode()) throw std::runtime_error(result.message());
    const auto* states = geometryOf(*result.getNode()).getStateSet();
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        states->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    return texture->getImage();
}

} // namespace

TEST_CASE("gltf: textures in WebP have the pixels of the picture", "[gltf]")
{
    constexpr int kWidth = 5, kHeight = 3;
    for (const bool transparent : {false, true})
    {
        INFO(transparent);
        std::vector<unsigned char> rgba;
        for (int i = 0; i < 4 * kWidth * kHeight; ++i)
            rgba.push_back(i % 4 < 3 || transparent ? static_cast<unsigned char>(255 - 4 * i)
                                                    : 255);
        const std::string bytes = webpBytes(rgba, kWidth, kHeight);
        const TemporaryFolder folder;
        std::ofstream(folder / "a b.webp", std::ios::binary) << bytes;
        Json model = triangleModel();
        const int view = addView(model, bytes);
        const auto inView = imageOf(model, {{"bufferView", view}, {"mimeType", "image/webp"}});
        const auto inText = imageOf(model, {{"uri", "data:image/webp;base64," + base64(bytes)}});
        const auto inFile = imageOf(model, {{"uri", "a%20b.webp"}}, folder / "");
        CHECK(inFile->getFileName().find("/a b.webp") != std::string::npos);
        for (const auto& image : {inView, inText, inFile})
        {
            REQUIRE(image->s() == kWidth);
            REQUIRE(image->t() == kHeight);
            const unsigned int channels = transparent ? 4 : 3;
            REQUIRE(image->getPixelFormat() == static_cast<GLenum>(transparent ? GL_RGBA : GL_RGB));
            CHECK(image->getWriteHint() == osg::Image::STORE_INLINE);
            for (int y = 0; y < kHeight; ++y) // ours begins at the bottom
                for (int x = 0; x < kWidth; ++x)
                    CHECK(std::memcmp(image->data(x, kHeight - 1 - y),
                                      rgba.data() + 4 * (y * kWidth + x), channels) == 0);
        }
    }
}

TEST_CASE("gltf: WebP files do not count against the memory of their model", "[gltf]")
{
    // The model may take 64 MiB and 16 times its own size. What stands behind an image is not read.
    const TemporaryFolder folder;
    std::ofstream(folder / "long.webp", std::ios::binary)
        << webpBytes(std::vector<unsigned char>(4 * 8 * 8, 77), 8, 8);
    std::filesystem::resize_file(folder / "long.webp", 70 << 20);
    const auto image = imageOf(triangleModel(), {{"uri", "long.webp"}}, folder / "");
    CHECK(image->s() == 8);

    std::filesystem::resize_file(folder / "long.webp", std::uintmax_t(1) << 33); // takes no disk
    const Listening listening;
    const auto none = imageOf(triangleModel(), {{"uri", "long.webp"}}, folder / "");
    CHECK_FALSE(none->data());
    CHECK(listening.text().find("is too large for an image") != std::string::npos);
}

TEST_CASE("gltf: damaged WebP images are named, and the model is there", "[gltf]")
{
    const std::string bytes = webpBytes(std::vector<unsigned char>(4 * 64 * 64, 77), 64, 64);
    const auto notices = [](const std::string& damaged)
    {
        const Listening listening;
        const auto image = imageOf(triangleModel(), {{"uri", "data:;base64," + base64(damaged)}});
        CHECK_FALSE(image->data());
        return listening.text();
    };
    CHECK(notices(bytes.substr(0, 14)).find("images[0]: does not say its size") !=
          std::string::npos);
    CHECK(notices(bytes.substr(0, bytes.size() - 12)).find("images[0]: its image cannot be read") !=
          std::string::npos);
}
#endif
