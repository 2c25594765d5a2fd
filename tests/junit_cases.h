#pragma once

#include "catch.h"

#include <tinyxml2.h>

#include <string>
#include <vector>

/// A test case of a JUnit file; `type` is empty if it passed.
struct JunitTestCase {
    std::string class_name, name, type, message, text;
};

inline std::string attribute(const tinyxml2::XMLElement& element, const char* name)
{
    const char* const value = element.Attribute(name);
    REQUIRE(value != nullptr);
    return value;
}

/// Returns the cases of a JUnit file. Checks that the counts in its two outer elements are right.
inline std::vector<JunitTestCase> cases_of(const std::string& junit)
{
    tinyxml2::XMLDocument document;
    REQUIRE(document.Parse(junit.data(), junit.size()) == tinyxml2::XML_SUCCESS);
    const tinyxml2::XMLElement* const suites = document.FirstChildElement("testsuites");
    REQUIRE(suites != nullptr);
    const tinyxml2::XMLElement* const suite = suites->FirstChildElement("testsuite");
    REQUIRE((suite != nullptr && suite->NextSiblingElement() == nullptr));
    std::vector<JunitTestCase> out;
    int failures = 0;
    const tinyxml2::XMLElement* next = suite->FirstChildElement("testcase");
    for (; next != nullptr; next = next->NextSiblingElement()) {
        JunitTestCase& test = out.emplace_back();
        test.class_name = attribute(*next, "classname");
        test.name = attribute(*next, "name");
        const tinyxml2::XMLElement* const failure = next->FirstChildElement("failure");
        if (failure == nullptr) continue;
        ++failures;
        test.type = attribute(*failure, "type");
        test.message = attribute(*failure, "message");
        test.text = failure->GetText();
    }
    for (const tinyxml2::XMLElement* const counted : {suites, suite}) {
        CHECK(attribute(*counted, "tests") == std::to_string(out.size()));
        CHECK(attribute(*counted, "failures") == std::to_string(failures));
        CHECK(attribute(*counted, "errors") == "0");
    }
    return out;
}
