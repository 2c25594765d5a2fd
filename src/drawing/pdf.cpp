#include "drawing/figure.h"

#include <hpdf.h>

#include <memory>
#include <stdexcept>

namespace spawnfield {
namespace {

constexpr float points_per_pixel = 0.72f;
constexpr double cap_height =
    0.718;  ///< height of Helvetica's capitals, as a share of the font size (Adobe, Core14 AFM)

/// libharu's error handler: keeps the first error.
void keep_first(HPDF_STATUS error, HPDF_STATUS, void* first)
{
    auto& kept = *static_cast<HPDF_STATUS*>(first);
    if (kept == HPDF_OK) kept = error;
}

/// Draws marks on a PDF page. After an error, all calls do nothing; take() throws the error.
class PdfWriter {
public:
    explicit PdfWriter(cv::Size size)
        : document_(HPDF_New(&keep_first, &error_)), height_(static_cast<float>(size.height))
    {
        if (!document_) throw std::bad_alloc();
        HPDF_SetCompressionMode(document_.get(), HPDF_COMP_ALL);
        page_ = HPDF_AddPage(document_.get());
        font_ = HPDF_GetFont(document_.get(), "Helvetica", "WinAnsiEncoding");
        HPDF_Page_SetWidth(page_, static_cast<float>(size.width) * points_per_pixel);
        HPDF_Page_SetHeight(page_, height_ * points_per_pixel);
        HPDF_Page_Concat(page_, points_per_pixel, 0, 0, points_per_pixel, 0, 0);
        HPDF_Page_SetLineJoin(page_, HPDF_ROUND_JOIN);
    }

    void operator()(const TextMark& mark)
    {
        const std::string text = printable(mark.text);
        HPDF_Page_SetFontAndSize(page_, font_, static_cast<float>(mark.style.cap / cap_height));
        const float width = HPDF_Page_TextWidth(page_, text.c_str());
        const float before = mark.style.align == Align::Left     ? 0
                             : mark.style.align == Align::Centre ? width / 2
                                                                 : width;
        if (mark.style.halo) {
            set_edge(*mark.style.halo, halo_width(mark.style.cap));
            write(text, mark.baseline, before, HPDF_STROKE);
        }
        set_inside(mark.style.colour);
        write(text, mark.baseline, before, HPDF_FILL);
    }
    void operator()(const AreaMark& mark)
    {
        set_inside(mark.colour);
        add_box(mark.area);
        HPDF_Page_Fill(page_);
    }
    void operator()(const PolygonMark& mark)
    {
        if (mark.corners.empty() || (!mark.inside && !(mark.edge_width > 0))) return;
        set_colours(mark.inside, mark.edge, mark.edge_width);
        HPDF_Page_MoveTo(page_, x_of(mark.corners[0]), y_of(mark.corners[0]));
        for (std::size_t k = 1; k < mark.corners.size(); ++k)
            HPDF_Page_LineTo(page_, x_of(mark.corners[k]), y_of(mark.corners[k]));
        HPDF_Page_ClosePath(page_);
        paint(mark.inside.has_value(), mark.edge_width > 0);
    }
    void operator()(const DotMark& mark)
    {
        set_colours(mark.inside, mark.edge, mark.edge_width);
        HPDF_Page_Circle(page_, x_of(mark.centre), y_of(mark.centre), static_cast<float>(mark.radius));
        paint(true, mark.edge_width > 0);
    }
    void operator()(const ImageMark& mark)
    {
        std::vector<HPDF_BYTE> bytes;
        bytes.reserve(3 * mark.pixels.total());
        for (const Colour& pixel : mark.pixels) bytes.insert(bytes.end(), {pixel[2], pixel[1], pixel[0]});
        const auto cols = static_cast<HPDF_UINT>(mark.pixels.cols), rows = static_cast<HPDF_UINT>(mark.pixels.rows);
        const HPDF_Image image = HPDF_LoadRawImageFromMem(document_.get(), bytes.data(), cols, rows, HPDF_CS_DEVICE_RGB,
                                                          8);
        const cv::Point2d lower(mark.corner.x, mark.corner.y + mark.pixels.rows);
        HPDF_Page_DrawImage(page_, image, x_of(lower), y_of(lower), static_cast<float>(cols), static_cast<float>(rows));
    }
    void operator()(const ClipMark& mark)
    {
        if (is_clipped_) HPDF_Page_GRestore(page_);
        is_clipped_ = !mark.area.empty();
        if (!is_clipped_) return;
        HPDF_Page_GSave(page_);
        add_box(mark.area);
        HPDF_Page_Clip(page_);
        HPDF_Page_EndPath(page_);
    }

    std::string take()
    {
        (*this)(ClipMark{});
        HPDF_SaveToStream(document_.get());
        if (error_ != HPDF_OK)
            throw std::runtime_error("the PDF cannot be created: libharu reports error " + std::to_string(error_));
        std::string bytes(HPDF_GetStreamSize(document_.get()), '\0');
        auto size = static_cast<HPDF_UINT32>(bytes.size());
        HPDF_ResetStream(document_.get());
        HPDF_ReadFromStream(document_.get(), reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
        return bytes;
    }

private:
    struct Free {
        void operator()(HPDF_Doc document) const { HPDF_Free(document); }
    };

    static float x_of(cv::Point2d place) { return static_cast<float>(place.x); }
    float y_of(cv::Point2d place) const { return height_ - static_cast<float>(place.y); }  // PDF's y points up
    static float share(std::uint8_t channel) { return static_cast<float>(channel) / 255; }

    void set_inside(Colour colour)
    {
        HPDF_Page_SetRGBFill(page_, share(colour[2]), share(colour[1]), share(colour[0]));
    }
    void set_edge(Colour colour, double width)
    {
        HPDF_Page_SetRGBStroke(page_, share(colour[2]), share(colour[1]), share(colour[0]));
        HPDF_Page_SetLineWidth(page_, static_cast<float>(width));
    }
    void add_box(const cv::Rect& area)
    {
        const cv::Point2d lower(area.x, area.y + area.height);
        HPDF_Page_Rectangle(page_, x_of(lower), y_of(lower), static_cast<float>(area.width),
                            static_cast<float>(area.height));
    }
    /// Sets the colours of a path. PDF requires this before the path begins.
    void set_colours(const std::optional<Colour>& inside, Colour edge, double edge_width)
    {
        if (inside) set_inside(*inside);
        if (edge_width > 0) set_edge(edge, edge_width);
    }
    void paint(bool is_filled, bool has_edge)
    {
        if (is_filled && has_edge)
            HPDF_Page_FillStroke(page_);
        else if (is_filled)
            HPDF_Page_Fill(page_);
        else
            HPDF_Page_Stroke(page_);
    }
    void write(const std::string& text, cv::Point2d baseline, float before, HPDF_TextRenderingMode mode)
    {
        HPDF_Page_BeginText(page_);
        HPDF_Page_SetTextRenderingMode(page_, mode);
        HPDF_Page_TextOut(page_, x_of(baseline) - before, y_of(baseline), text.c_str());
        HPDF_Page_EndText(page_);
    }

    HPDF_STATUS error_ = HPDF_OK;  ///< the first error
    std::unique_ptr<std::remove_pointer_t<HPDF_Doc>, Free> document_;
    HPDF_Page page_ = nullptr;
    HPDF_Font font_ = nullptr;
    float height_;  ///< height of the picture, pixels
    bool is_clipped_ = false;
};

}  // namespace

std::string pdf_of(const Figure& figure)
{
    PdfWriter writer(figure.size);
    for (const Mark& mark : figure.marks) std::visit(writer, mark);
    return writer.take();
}

}  // namespace spawnfield
