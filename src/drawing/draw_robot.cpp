#include "drawing/figure.h"
#include "picture/silhouette.h"
#include "drawing/ticks.h"
#include "picture/drawing_module.h"

#include <spawnfield/robot_picture.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace spawnfield {
namespace {

constexpr double label_cap = 10, number_cap = 8, heading_cap = 14, line_step = 19;  // pixels
constexpr double left = 66, right = 24, top = 66, bottom = 46, pane_gap = 74;
constexpr double least_legend = 250;  // width, pixels

/// A view with its title and the names of its two axes. `nearness` is the direction towards the viewer.
struct Axes : ViewAxes {
    Vec3 nearness;
    const char* heading;
    const char *u_name, *v_name;
};

const Axes seen_from_above{{Vec3::UnitX(), Vec3::UnitY()}, Vec3::UnitZ(), "from above", "x", "y"};
const Axes seen_from_right{{Vec3::UnitX(), Vec3::UnitZ()}, -Vec3::UnitY(), "from its right side", "x", "z"};
const Axes seen_from_front{{Vec3::UnitY(), Vec3::UnitZ()}, Vec3::UnitX(), "from the front", "y", "z"};

/// The colours of links, in the order of the file. After eight links the colours repeat.
class LinkColours {
public:
    explicit LinkColours(const Robot& robot)
    {
        for (const RobotPart& part : robot.parts)
            if (index_.try_emplace(part.name, names_.size()).second) names_.push_back(part.name);
    }
    const std::vector<std::string>& names() const { return names_; }
    Colour of(const std::string& name) const
    {
        constexpr std::array colours{0x56b4e9u, 0xe69f00u, 0x009e73u, 0xf0e442u,
                                     0xcc79a7u, 0x999999u, 0xd55e00u, 0x0072b2u};
        const Colour colour = rgb(colours[index_.at(name) % colours.size()]);
        const auto lighter = [&](int c) { return static_cast<std::uint8_t>(colour[c] + (255 - colour[c]) * 45 / 100); };
        return {lighter(0), lighter(1), lighter(2)};
    }

private:
    std::map<std::string, std::size_t> index_;
    std::vector<std::string> names_;
};

/// A view with its place in the picture.
struct Pane {
    Axes axes;
    cv::Rect area;          ///< pixels
    double u0 = 0, v0 = 0;  ///< coordinates of its lower left corner, m
    double scale = 1;       ///< pixels per metre

    cv::Point2d pixel(double u, double v) const { return {area.x + (u - u0) * scale, area.br().y - (v - v0) * scale}; }
    cv::Point2d pixel(const Vec3& point) const { return pixel(axes.u.dot(point), axes.v.dot(point)); }
};

std::vector<cv::Point2d> on_paper(const Pane& pane, const Polygon2& polygon)
{
    std::vector<cv::Point2d> out;
    for (const Vec2& corner : polygon) out.push_back(pane.pixel(corner.x(), corner.y()));
    return out;
}

/// Returns the box that the views must show: the robot, its origin and its contacts, with some room around them.
Bounds shown_bounds(const Robot& robot, const RobotContacts& contacts)
{
    Bounds bounds = robot.bounds();
    bounds.extend(Vec3::Zero());
    for (const Vec3& contact : contacts.points) bounds.extend(contact);
    const double room = 0.06 * (bounds.max - bounds.min).maxCoeff();
    bounds.min.array() -= room;
    bounds.max.array() += room;
    return bounds;
}

struct Sheet {
    std::array<Pane, 3> panes;
    cv::Rect legend;
    cv::Size size;
};

/// Returns the places of the views and the legend: from above in the upper left, from the right below it, from the
/// front in the lower right, the legend in the upper right.
Sheet lay_out(const Bounds& bounds)
{
    constexpr double width = 1000, most_height = 1100;
    const Vec3 size = bounds.max - bounds.min;
    const double room = width - left - right - pane_gap;
    double scale = std::min(room / (size.x() + size.y()),
                            (most_height - top - bottom - pane_gap) / (size.y() + size.z()));
    if (size.y() * scale < least_legend) scale = std::min(scale, (room - least_legend) / size.x());
    const auto pane = [&](const Axes& axes, double x, double y) {
        const double u = axes.u.dot(bounds.min), v = axes.v.dot(bounds.min);
        return Pane{axes,
                    {cvRound(x), cvRound(y), whole(axes.u.dot(size) * scale), whole(axes.v.dot(size) * scale)},
                    u,
                    v,
                    scale};
    };
    // The legend needs some height too, even if the view from above is flat.
    const double first_row = std::max(size.y() * scale, 300.0);
    const double second = left + size.x() * scale + pane_gap, below = top + first_row + pane_gap;
    Sheet sheet;
    sheet.panes = {pane(seen_from_above, left, top), pane(seen_from_right, left, below),
                   pane(seen_from_front, second, below)};
    sheet.legend = {cvRound(second), int(top), cvRound(std::max(width - right - second, least_legend)),
                    whole(first_row)};
    sheet.size = {int(width), cvRound(below + size.z() * scale + bottom)};
    return sheet;
}

void draw_grid(Figure& figure, const Pane& pane)
{
    const Colour grid = rgb(0xe4e4e4);
    const RoundStep step = round_up(60 / pane.scale);
    const Ticks us = ticks_within(pane.u0, pane.u0 + pane.area.width / pane.scale, step);
    const Ticks vs = ticks_within(pane.v0, pane.v0 + pane.area.height / pane.scale, step);
    for (int k = 0; k < us.count; ++k) {
        const double x = pane.pixel(us.value(k), 0).x;
        fill(figure, {cvRound(x - 0.5), pane.area.y, 1, pane.area.height}, grid);
        draw_text(figure, us.label(k), {x, pane.area.br().y + 8 + number_cap}, {number_cap, muted, Align::Centre});
    }
    for (int k = 0; k < vs.count; ++k) {
        const double y = pane.pixel(0, vs.value(k)).y;
        fill(figure, {pane.area.x, cvRound(y - 0.5), pane.area.width, 1}, grid);
        draw_text(figure, vs.label(k), {pane.area.x - 8.0, y + number_cap / 2}, {number_cap, muted, Align::Right});
    }
    const std::string names = std::string(pane.axes.u_name) + " right, " + pane.axes.v_name + " up, m";
    draw_text(figure, pane.axes.heading, {double(pane.area.x), pane.area.y - 9.0}, {label_cap});
    const double used = text_width(pane.axes.heading, label_cap);
    if (used + 16 + text_width(names, number_cap) < pane.area.width)
        draw_text(figure, names, {double(pane.area.br().x), pane.area.y - 9.0}, {number_cap, muted, Align::Right});
}

/// Draws the parts, the farthest first. A thick line shows the outline of their union; thin lines show the outline of
/// each part, also where another part hides it.
void draw_parts(Figure& figure, const Pane& pane, const Robot& robot, const LinkColours& colours)
{
    std::vector<std::vector<cv::Point2d>> outlines;
    std::vector<std::size_t> order(robot.parts.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::vector<double> nearness;
    for (const RobotPart& part : robot.parts) {
        outlines.push_back(on_paper(pane, silhouette(part, pane.axes)));
        const Bounds box = part.bounds();
        nearness.push_back(std::max(pane.axes.nearness.dot(box.min), pane.axes.nearness.dot(box.max)));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return nearness[a] < nearness[b]; });
    for (const auto& corners : outlines) draw_polygon(figure, corners, ink, ink, 5);
    for (const std::size_t k : order)
        draw_polygon(figure, outlines[k], colours.of(robot.parts[k].name), rgb(0x4d4d4d), 1);
    for (const auto& corners : outlines) draw_outline(figure, corners, rgb(0x8c8c8c), 1);
}

/// Draws a contact: large and dark if the robot's file gives it, otherwise small, because derived contacts may be many
/// and close together.
void draw_contact(Figure& figure, cv::Point2d place, bool given)
{
    draw_dot(figure, place, given ? 5 : 2.5, given ? ink : white, given ? white : ink, given ? 1.6 : 1);
}

void draw_contacts(Figure& figure, const Pane& pane, const RobotContacts& contacts)
{
    for (const Vec3& contact : contacts.points) draw_contact(figure, pane.pixel(contact), contacts.given);
}

/// Draws arrows from the origin along the two axes of the view.
void draw_axes(Figure& figure, const Pane& pane)
{
    const cv::Point2d origin = pane.pixel(0, 0);
    constexpr double length = 46, head = 9;
    const auto arrow = [&](cv::Point2d along, const char* name) {
        const cv::Point2d tip = origin + length * along, side(-along.y, along.x);
        draw_polygon(figure, {origin, tip - head * along}, ink, ink, 2);
        draw_polygon(figure, {tip, tip - head * along + 4.5 * side, tip - head * along - 4.5 * side}, ink, ink, 1);
        const cv::Point2d place = tip + 9.0 * along;
        draw_text(figure, name, {place.x, place.y + label_cap / 2}, {label_cap, ink, Align::Centre});
    };
    arrow({1, 0}, pane.axes.u_name);
    arrow({0, -1}, pane.axes.v_name);
    draw_dot(figure, origin, 3.5, white, ink, 1.5);
}

/// Returns a length in m, rounded to millimetres.
std::string millimetres(double value)
{
    const std::string text = fixed(value, 3);
    return text == "-0.000" ? "0.000" : text;
}

/// Writes the legend line by line, from the top down.
class LegendWriter {
public:
    LegendWriter(Figure& figure, const cv::Rect& area) : figure_(figure), area_(area), y_(area.y + label_cap) {}

    void text(const std::string& words, Colour colour = ink)
    {
        draw_text(figure_, cut_to(words, label_cap, area_.width), {double(area_.x), y_}, {label_cap, colour});
        y_ += line_step;
    }
    void swatch(Colour colour, const std::string& words)
    {
        const cv::Rect box(area_.x, cvRound(y_ - label_cap - 1), 18, 12);
        fill(figure_, box, colour);
        outline(figure_, box, 1, muted);
        draw_text(figure_, cut_to(words, label_cap, area_.width - 28), {area_.x + 28.0, y_}, {label_cap});
        y_ += line_step;
    }
    void contact(bool given, const std::string& words)
    {
        draw_contact(figure_, {area_.x + 9.0, y_ - label_cap / 2}, given);
        draw_text(figure_, cut_to(words, label_cap, area_.width - 28), {area_.x + 28.0, y_}, {label_cap});
        y_ += line_step;
    }
    void thick_line(const std::string& words)
    {
        fill(figure_, {area_.x, cvRound(y_ - label_cap / 2 - 1), 18, 3}, ink);
        draw_text(figure_, cut_to(words, label_cap, area_.width - 28), {area_.x + 28.0, y_}, {label_cap});
        y_ += line_step;
    }
    void scale_bar(double scale)
    {
        const RoundStep step = round_down(0.6 * area_.width / scale);
        const int length = whole(step.value * scale), y = cvRound(y_ - 4);
        fill(figure_, {area_.x, y, length, 3}, ink);
        fill(figure_, {area_.x, y - 4, 2, 11}, ink);
        fill(figure_, {area_.x + length - 2, y - 4, 2, 11}, ink);
        draw_text(figure_, fixed(step.value, step.decimals) + " m", {area_.x + length + 10.0, y + label_cap / 2 + 1},
                  {label_cap});
        y_ += line_step + 4;
    }
    void gap() { y_ += line_step / 2; }
    int remaining_lines() const { return int((area_.br().y - y_) / line_step) + 1; }

private:
    Figure& figure_;
    const cv::Rect area_;
    double y_;
};

void write_legend(Figure& figure, const Sheet& sheet, const Robot& robot, const RobotContacts& contacts,
                  const LinkColours& colours)
{
    LegendWriter legend(figure, sheet.legend);
    const Bounds bounds = robot.bounds();
    const Vec3 size = bounds.max - bounds.min;
    legend.scale_bar(sheet.panes[0].scale);
    legend.text(millimetres(size.x()) + " x " + millimetres(size.y()) + " x " + millimetres(size.z()) + " m");
    const double low = bounds.min.z();
    legend.text("lowest point " + (std::abs(low) < 5e-4 ? "at the height of the origin"
                                                        : millimetres(std::abs(low)) +
                                                              (low < 0 ? " m below origin" : " m above origin")));
    legend.text("turns within " + millimetres(turning_radius(robot)) + " m of its origin");
    legend.gap();
    legend.thick_line("footprint");
    legend.contact(contacts.given, contacts.given ? "contacts" : "contacts taken: none given");
    legend.gap();
    const auto& names = colours.names();
    if (names.size() == 1 && names[0].empty()) return;
    const std::size_t room = std::size_t(std::max(legend.remaining_lines(), 3));
    const std::size_t listed = names.size() <= room ? names.size() : room - 1;
    for (std::size_t k = 0; k < listed; ++k)
        legend.swatch(colours.of(names[k]), names[k].empty() ? "(no name)" : names[k]);
    if (listed < names.size()) legend.text("and " + std::to_string(names.size() - listed) + " more", muted);
}

}  // namespace

void drawing_module::write_robot_picture(const Robot& robot, const std::filesystem::path& file)
{
    const PictureFormat format = picture_format(file);
    const RobotContacts contacts = robot_contacts(robot);
    const Sheet sheet = lay_out(shown_bounds(robot, contacts));
    const LinkColours colours(robot);
    Figure figure{sheet.size, {}};
    for (const Pane& pane : sheet.panes) {
        draw_grid(figure, pane);
        draw_parts(figure, pane, robot, colours);
        draw_contacts(figure, pane, contacts);
        draw_axes(figure, pane);
        outline(figure, pane.area, 1, muted);
    }
    draw_text(figure, cut_to(robot.name, heading_cap, sheet.size.width - left - right), {left, 30}, {heading_cap});
    write_legend(figure, sheet, robot, contacts, colours);
    write_figure(figure, format, file);
}

}  // namespace spawnfield
