#include "model/sdf_text.h"

namespace spawnfield {
namespace {

/// Prints XML without some elements. All others stay on their lines.
class LinePrinter : public tinyxml2::XMLPrinter {
public:
    explicit LinePrinter(const std::set<const Xml*>& removed) : XMLPrinter(nullptr, true), removed_(removed) {}

    bool VisitEnter(const Xml& element, const tinyxml2::XMLAttribute* attributes) override
    {
        if (removed_.contains(&element)) return false;
        go_to(element.GetLineNum());
        return XMLPrinter::VisitEnter(element, attributes);
    }

    bool VisitExit(const Xml& element) override
    {
        return removed_.contains(&element) || XMLPrinter::VisitExit(element);
    }
    using XMLPrinter::VisitEnter, XMLPrinter::VisitExit;

private:
    /// Prints line ends up to the line of the element. The tag before may still be open here; a line may end within a
    /// tag.
    void go_to(int line)
    {
        for (const int end = CStrSize() - 1; counted_ < end; ++counted_) line_ += CStr()[counted_] == '\n';
        for (; line_ < line; ++line_) Write("\n", 1);
        counted_ = CStrSize() - 1;
    }

    const std::set<const Xml*>& removed_;
    int line_ = 1;     ///< current line of the printed text
    int counted_ = 0;  ///< number of characters whose line ends are counted
};

}  // namespace

std::string text_without(const tinyxml2::XMLDocument& document, const std::set<const Xml*>& removed)
{
    LinePrinter printer(removed);
    document.Accept(&printer);
    return printer.CStr();
}

}  // namespace spawnfield
