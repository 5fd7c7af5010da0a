// CaveParser.cpp - elements and attributes, read leniently; nonsense is refused. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveFile.h"

#include "apps/common/Failure.h"

#include <cctype>

namespace osgRayTrace::app
{

namespace
{

constexpr std::size_t kDeepest = 64;

class Parser
{
public:
    Parser(const std::string& text, const std::string& file, std::size_t& partsLeft)
        : _text(text), _file(file), _partsLeft(partsLeft)
    {
    }

    CaveElement parse()
    {
        CaveElement root;
        root.file = _file;
        root.line = 1;
        parseContent(root, 0);
        return root;
    }

private:
    [[noreturn]] void fail(int line, const std::string& message) const
    {
        throw Failure(kCannotLoad, _file + ":" + std::to_string(line) + ": " + message);
    }

    bool atEnd() const { return _at >= _text.size(); }
    bool startsWith(const char* what) const
    {
        return _text.compare(_at, std::string(what).size(), what) == 0;
    }

    char take()
    {
        if (_text[_at] == '\n') ++_line;
        return _text[_at++];
    }

    void skipBlanks()
    {
        while (!atEnd() && std::isspace(static_cast<unsigned char>(_text[_at])))
            take();
    }

    /// Skips past end. what: name of the part, for the message.
    void skipPast(const char* end, const char* what)
    {
        const int line = _line;
        while (!startsWith(end))
        {
            if (atEnd()) fail(line, std::string(what) + " has no end");
            take();
        }
        _at += std::string(end).size();
    }

    /// Reads up to the end tag of the element, or of the file.
    void parseContent(CaveElement& parent, std::size_t depth)
    {
        while (!atEnd())
        {
            if (startsWith("<!--"))
                skipPast("-->", "comment");
            else if (startsWith("<?"))
                skipPast("?>", "<?");
            else if (startsWith("<!"))
                skipPast(">", "<!");
            else if (startsWith("</"))
                return endElement(parent, depth);
            else if (startsWith("<"))
                parseElement(parent, depth);
            else
                parent.text += take();
        }
        if (depth > 0) fail(parent.line, "<" + parent.name + "> has no end");
    }

    void endElement(const CaveElement& element, std::size_t depth)
    {
        _at += 2;
        const std::string name = takeName();
        skipBlanks();
        if (depth == 0) fail(_line, "</" + name + "> has no beginning");
        if (name != element.name)
            fail(_line, "</" + name + "> ends <" + element.name + "> of line " +
                            std::to_string(element.line));
        if (atEnd() || take() != '>') fail(_line, "</" + name + " has no >");
    }

    /// Counts one more element or attribute.
    void countPart()
    {
        if (_partsLeft-- == 0)
            fail(_line, "there are more than " + std::to_string(kMostCaveParts) +
                            " elements and attributes");
    }

    void parseElement(CaveElement& parent, std::size_t depth)
    {
        countPart();
        CaveElement element;
        element.line = _line;
        element.file = _file;
        take();
        element.name = takeName();
        if (element.name.empty()) fail(_line, "< without a name");
        if (depth >= kDeepest) fail(_line, "<" + element.name + "> is too deep");
        if (!parseAttributes(element)) parseContent(element, depth + 1);
        parent.children.push_back(std::move(element));
    }

    /// Reads attributes; returns true if the element ends with them.
    bool parseAttributes(CaveElement& element)
    {
        for (;;)
        {
            skipBlanks();
            if (atEnd() || startsWith("<")) fail(element.line, "<" + element.name + " has no >");
            if (startsWith("/>"))
            {
                _at += 2;
                return true;
            }
            if (startsWith(">"))
            {
                take();
                return false;
            }
            const int line = _line;
            countPart();
            const std::string name = takeName();
            if (name.empty())
                fail(line, "<" + element.name + ">: '" + _text[_at] + "' begins no attribute");
            skipBlanks();
            if (!startsWith("=")) fail(line, "<" + element.name + ">: " + name + " has no value");
            take();
            skipBlanks();
            element.attributes.emplace_back(name, takeValue(element, name));
        }
    }

    std::string takeName()
    {
        std::string name;
        const auto belongs = [](char c)
        {
            return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' ||
                   c == '.' || c == ':';
        };
        while (!atEnd() && belongs(_text[_at]))
            name += take();
        return name;
    }

    std::string takeValue(const CaveElement& element, const std::string& name)
    {
        const int line = _line;
        const char quote = atEnd() ? ' ' : _text[_at];
        if (quote != '"' && quote != '\'')
            fail(line, "<" + element.name + ">: the value of " + name + " is not quoted");
        take();
        std::string value;
        while (atEnd() || _text[_at] != quote)
        {
            if (atEnd() || _text[_at] == '<')
                fail(line, "<" + element.name + ">: the value of " + name + " has no end");
            value += take();
        }
        take();
        return value;
    }

    const std::string& _text;
    const std::string& _file;
    std::size_t& _partsLeft;
    std::size_t _at = 0;
    int _line = 1;
};

} // namespace

CaveElement parseCave(const std::string& text, const std::string& file, std::size_t& partsLeft)
{
    return Parser(text, file, partsLeft).parse();
}

} // namespace osgRayTrace::app
