// MaterialLibrary.cpp - reads material files, and reports their errors with their places. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"

#include "osgRayTrace/base/TextFile.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialParameters.h"
#include "osgRayTrace/bridge/appearance/materials/ShaderRuleReader.h"
#include "osgRayTrace/bridge/common/LineIterator.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <nlohmann/json.hpp>
#include <osgDB/FileUtils>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

using Json = nlohmann::json;

/// Stands for the flag of rules that edit, which is no parameter of a material.
const Parameter kEdits = {"edits", 1, 0.0, 1.0, nullptr, nullptr, true};

constexpr std::size_t kMostBytes = std::size_t(16) << 20;

std::string shortNumber(double value)
{
    return Json(value).dump();
}

/// Returns what the rules read.
ShaderReads readsOf(const std::vector<ShaderRule>& rules)
{
    ShaderReads reads;
    const auto add = [&reads](const ValueSource& source)
    {
        if (source.kind == ValueSource::Kind::Uniform) reads.uniforms.push_back(source.pattern);
    };
    for (const ShaderRule& rule : rules)
    {
        reads.userValues = reads.userValues || rule.readsUserValues();
        reads.attributes = reads.attributes || rule.attributes.any();
        for (const ParameterRule& parameter : rule.parameters)
            add(parameter.source);
        if (rule.alphaReference) add(*rule.alphaReference);
        for (const std::optional<TextureSource>& texture : rule.textures)
            if (texture && texture->kind == TextureSource::Kind::Sampler)
                reads.uniforms.push_back(texture->pattern);
    }
    return reads;
}

/// Handles the parser's events; returning false ends the parse. Depth 1 is the file, 2 a group, 3 a
/// material. The group "shaders" is an array, of which a tree is made first.
class LibraryReader : public Json::json_sax_t
{
public:
    LibraryReader(const std::string& fileName, const int& line) : _fileName(fileName), _line(line)
    {
    }

    const std::string& error() const { return _error; }
    std::shared_ptr<MaterialLibrary> materials() { return _library; }

    bool null() override { return _tree.isOpen() ? addToTree({}) : wrongType("null"); }

    bool boolean(bool value) override
    {
        if (!_tree.isOpen()) return wrongType("true or false");
        LocatedJson json;
        json.kind = LocatedJson::Kind::Boolean;
        json.boolean = value;
        return addToTree(std::move(json));
    }

    bool number_integer(number_integer_t value) override { return number(double(value)); }
    bool number_unsigned(number_unsigned_t value) override { return number(double(value)); }
    bool number_float(number_float_t value, const string_t&) override { return number(value); }

    bool string(string_t& value) override
    {
        if (!_tree.isOpen()) return wrongType("a string");
        LocatedJson json;
        json.kind = LocatedJson::Kind::Text;
        json.text = value;
        return addToTree(std::move(json));
    }

    bool binary(binary_t&) override { return wrongType("binary data"); }

    bool start_object(std::size_t) override
    {
        if (_tree.isOpen()) return openTree(LocatedJson::Kind::Object);
        if (_isShaders) return fail("an array of rules was expected, not an object");
        if (_depth >= 3 || _inArray) return wrongType("an object");
        ++_depth;
        return true;
    }

    bool end_object() override
    {
        if (_tree.isOpen()) return closeTree();
        --_depth;
        return true;
    }

    bool start_array(std::size_t) override
    {
        if (_tree.isOpen() || _isShaders) return openTree(LocatedJson::Kind::Array);
        if (_depth < 3 || _inArray || _parameter->count == 1) return wrongType("an array");
        _inArray = true;
        _values.clear();
        return true;
    }

    bool end_array() override
    {
        if (_tree.isOpen()) return closeTree();
        _inArray = false;
        return _values.size() == _parameter->count ? set()
                                                   : wrongType("an array of another length");
    }

    bool key(string_t& name) override
    {
        _keyLine = _line;
        if (_tree.isOpen())
        {
            _tree.key(name, _line);
            return true;
        }
        if (_depth == 1) return beginGroup(name);
        return _depth == 2 ? beginMaterial(name) : beginParameter(name);
    }

    bool parse_error(std::size_t, const std::string&, const Json::exception& exception) override
    {
        // The text looks like "[json.exception.parse_error.101] parse error at line 3, column 7:
        // ...".
        const std::string text = exception.what();
        const std::size_t bracket = text.find("] ");
        const std::string what = bracket == std::string::npos ? text : text.substr(bracket + 2);
        // Errors of numbers that are too large tell no line.
        const bool hasPlace = what.find("line ") != std::string::npos;
        _error = _fileName + (hasPlace ? ": " : ":" + std::to_string(_keyLine) + ": ") + what;
        return false;
    }

private:
    bool fail(const std::string& what)
    {
        std::string where = _fileName + ":" + std::to_string(_keyLine) + ": ";
        if (_depth >= 2) where += _group + ": ";
        if (_depth >= 3) where += "'" + _pattern + "': ";
        _error = where + what;
        return false;
    }

    bool addToTree(LocatedJson json)
    {
        _tree.add(std::move(json));
        return true;
    }

    bool openTree(LocatedJson::Kind kind)
    {
        return _tree.open(kind, _line) || fail("'shaders': a value lies too deep");
    }

    bool closeTree()
    {
        if (!_tree.close()) return true;
        _isShaders = false;
        const LocatedJson rules = _tree.take();
        if (rules.children.size() > kMostPatterns)
            return fail("'shaders': more than " + std::to_string(kMostPatterns) + " rules");
        for (const LocatedJson& json : rules.children)
        {
            ShaderRuleResult result = readShaderRule(json, _library->shaders.size() + 1);
            if (!result.error.empty())
            {
                _error =
                    _fileName + ":" + std::to_string(result.line) + ": shaders: " + result.error;
                return false;
            }
            _library->shaders.push_back(std::move(result.rule));
        }
        if (_library->shaders.empty()) return true;
        _library->reads = std::make_shared<ShaderReads>(readsOf(_library->shaders));
        _library->readsUserValues = _library->reads->userValues;
        return true;
    }

    bool beginGroup(const std::string& name)
    {
        if (name == "shaders")
        {
            if (std::exchange(_hasShaders, true)) return fail("'" + name + "' is there twice");
            _isShaders = true;
            return true;
        }
        _rules = name == "nodes"       ? &_library->nodes
                 : name == "materials" ? &_library->materials
                 : name == "textures"  ? &_library->textures
                                       : nullptr;
        if (!_rules) return fail("'" + name + "' is none of nodes, materials, textures, shaders");
        if (!_rules->empty()) return fail("'" + name + "' is there twice");
        _group = name;
        return true;
    }

    bool beginMaterial(const std::string& name)
    {
        if (name.empty()) return fail("a name is empty");
        _material = new PhysicalMaterial;
        _material->setName(name);
        _rule = _rules->add({_group, name, _material, true, false, {}});
        if (!_rule) return fail("'" + name + "' is there twice");
        if (_rules->patterns() > kMostPatterns)
            return fail("'" + name + "': more than " + std::to_string(kMostPatterns) +
                        " names with '*'");
        _pattern = name;
        _given.clear();
        return true;
    }

    bool beginParameter(const std::string& name)
    {
        _parameter = name == kEdits.name ? &kEdits : findParameter(name);
        if (!_parameter)
            return fail("'" + name + "' is no parameter; there are " + parameterNames() +
                        ", and edits");
        if (std::find(_given.begin(), _given.end(), name) != _given.end())
            return fail("'" + name + "' is there twice");
        _given.push_back(name);
        if (name == "baseColor") _rule->keepsColor = false;
        return true;
    }

    bool number(double value)
    {
        if (_tree.isOpen())
        {
            LocatedJson json;
            json.kind = LocatedJson::Kind::Number;
            json.number = value;
            return addToTree(std::move(json));
        }
        if (_depth < 3 || (!_inArray && _parameter->count != 1)) return wrongType("a number");
        if (!(value >= _parameter->lowest && value <= _parameter->highest))
            return fail("'" + std::string(_parameter->name) + "': " + shortNumber(value) +
                        " is not from " + shortNumber(_parameter->lowest) + " to " +
                        shortNumber(_parameter->highest));
        if (_parameter->isWhole && value != std::floor(value))
            return fail("'" + std::string(_parameter->name) + "': " + shortNumber(value) +
                        " is no whole number");
        if (!_inArray) _values.clear();
        _values.push_back(value);
        if (_values.size() > _parameter->count) return wrongType("an array of another length");
        return _inArray || set();
    }

    bool set()
    {
        if (_parameter == &kEdits)
        {
            _rule->edits = _values[0] != 0.0;
            return true;
        }
        _parameter->set(*_material, _values);
        _rule->given.emplace_back(_parameter, _values);
        return true;
    }

    bool wrongType(const char* found)
    {
        if (_depth == 0) return fail(std::string("an object was expected, not ") + found);
        if (_isShaders) return fail(std::string("an array of rules was expected, not ") + found);
        if (_depth < 3)
            return fail(std::string("an object was expected for the name, not ") + found);
        return fail("'" + std::string(_parameter->name) +
                    "': " + (_parameter->count == 1 ? "a number" : "an array of three numbers") +
                    " was expected, not " + found);
    }

    const std::string& _fileName;
    const int& _line;
    int _keyLine = 1;
    int _depth = 0;
    bool _inArray = false;
    bool _isShaders = false;  ///< true: the value of "shaders" is being read
    bool _hasShaders = false; ///< true: "shaders" has begun
    LocatedJsonBuilder _tree;
    std::shared_ptr<MaterialLibrary> _library = std::make_shared<MaterialLibrary>();
    MaterialRuleList* _rules = nullptr;
    MaterialRule* _rule = nullptr;
    osg::ref_ptr<PhysicalMaterial> _material;
    const Parameter* _parameter = nullptr;
    Values _values;
    std::vector<std::string> _given; ///< parameters of the material
    std::string _group, _pattern, _error;
};

} // namespace

MaterialLibraryResult parseMaterialLibrary(const std::string& text, const std::string& fileName)
{
    int line = 1;
    LibraryReader reader(fileName, line);
    const LineIterator begin{text.data(), &line}, end{text.data() + text.size(), &line};
    if (Json::sax_parse(begin, end, &reader)) return {reader.materials(), {}};
    return {nullptr, reader.error()};
}

MaterialLibraryResult readMaterialLibrary(const std::string& fileName)
{
    const std::string found = osgDB::findDataFile(fileName);
    const FileText read = readTextFile(found.empty() ? fileName : found, kMostBytes);
    if (!read.error.empty()) return {nullptr, fileName + ": " + read.error};
    return parseMaterialLibrary(read.text, fileName);
}

std::shared_ptr<const MaterialLibrary> MaterialLibraryFile::materials(const std::string& fileName,
                                                                      bool again)
{
    if (fileName == _fileName && !again) return _library;
    _fileName = fileName;
    _library = nullptr;
    if (fileName == "none") return nullptr;
    MaterialLibraryResult result = readMaterialLibrary(fileName);
    if (!result.error.empty()) warnOnce("materials: " + result.error);
    _library = std::move(result.library);
    return _library;
}

} // namespace osgRayTrace::engine
