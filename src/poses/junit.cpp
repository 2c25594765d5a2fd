#include "poses/junit.h"

#include "base/text.h"
#include "poses/pose_json.h"

#include <tinyxml2.h>

namespace spawnfield {
namespace {

class JunitWriter {
public:
    JunitWriter(const JunitReport& report, const TextSink& sink) : report_(report), sink_(sink) {}

    void write()
    {
        printer_.PushDeclaration("xml version=\"1.0\" encoding=\"UTF-8\"");
        printer_.OpenElement("testsuites");
        push_counts("spawnfield " + report_.command);
        printer_.OpenElement("testsuite");
        push_counts("spawnfield " + report_.command + " " + report_.map);
        push("skipped", "0");
        push_properties();
        for (std::size_t i = 0; i < report_.cases; ++i) {
            push_case(report_.test_case(i));
            if (std::size_t(printer_.CStrSize()) > text_piece) flush();
        }
        printer_.CloseElement();
        printer_.CloseElement();
        flush();
    }

private:
    void push(const char* name, const std::string& value) { printer_.PushAttribute(name, xml_text(value).c_str()); }

    /// Adds the name and the counts. Some readers need a time; it is 0, because a measured time would differ from run
    /// to run.
    void push_counts(const std::string& name)
    {
        push("name", name);
        push("tests", std::to_string(report_.cases));
        push("failures", std::to_string(report_.failures));
        push("errors", "0");
        push("time", "0");
    }

    void push_properties()
    {
        printer_.OpenElement("properties");
        for (const auto& [name, value] : report_.properties) {
            printer_.OpenElement("property");
            push("name", name);
            push("value", value);
            printer_.CloseElement();
        }
        printer_.CloseElement();
    }

    void push_case(const JunitCase& test)
    {
        printer_.OpenElement("testcase");
        push("classname", report_.map + "." + (test.group.empty() ? report_.robot : test.group));
        push("name", test.name);
        push("time", "0");
        if (!test.type.empty()) {
            printer_.OpenElement("failure");
            push("type", test.type);
            push("message", test.message);
            printer_.PushText(test.details.c_str());
            printer_.CloseElement();
        }
        printer_.CloseElement();
    }

    void flush()
    {
        sink_(printer_.CStr());
        printer_.ClearBuffer(false);
    }

    const JunitReport& report_;
    const TextSink& sink_;
    tinyxml2::XMLPrinter printer_;
};

}  // namespace

std::string xml_text(const std::string& text)
{
    // json_text replaces bytes that are not valid UTF-8.
    std::string out = one_line(Json::parse(json_text(text, -1)).get<std::string>());
    for (const char* const forbidden : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})  // U+FFFE, U+FFFF
        for (std::size_t place = out.find(forbidden); place != std::string::npos; place = out.find(forbidden, place))
            out.replace(place, 3, "\xEF\xBF\xBD");
    return out;
}

void write_junit(const JunitReport& report, const TextSink& sink) { JunitWriter(report, sink).write(); }

}  // namespace spawnfield
