#include "model/sdf_text.h"

namespace spawnfield {
namespace {

class LinePrinter : public tinyxml2::XMLPrinter {
public:
    explicit LinePrinter(const std::set<const Xml*>& gone) : XMLPrinter(nullptr, true), gone_(gone) {}

    bool VisitEnter(const Xml& element, const tinyxml2::XMLAttribute* attributes) override
    {
        if (gone_.contains(&element)) return false;
        go_to(element.GetLineNum());
        return XMLPrinter::VisitEnter(element, attributes);
    }

    bool VisitExit(const Xml& element) override { return gone_.contains(&element) || XMLPrinter::VisitExit(element); }
    using XMLPrinter::VisitEnter, XMLPrinter::VisitExit;

private:
    /// The tag before may still be open here: a line may end within it.
    void go_to(int line)
    {
        for (const int end = CStrSize() - 1; counted_ < end; ++counted_) line_ += CStr()[counted_] == '\n';
        for (; line_ < line; ++line_) Write("\n", 1);
        counted_ = CStrSize() - 1;
    }

    const std::set<const Xml*>& gone_;
    int line_ = 1;     ///< at the end of what is printed
    int counted_ = 0;  ///< characters in which line ends were looked for
};

}  // namespace

std::string text_without(const tinyxml2::XMLDocument& document, const std::set<const Xml*>& gone)
{
    LinePrinter printer(gone);
    document.Accept(&printer);
    return printer.CStr();
}

}  // namespace spawnfield
