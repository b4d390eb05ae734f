// Small pieces that the report's pages are made of.
#pragma once

#include "base/result.h"
#include "conformance/report/picture.h"
#include "conformance/report/report.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace vernier::conformance {

/// Text with the characters HTML gives a meaning replaced.
std::string escapeHtml(std::string_view text);

/// An <img> with the picture inside it; `attributes` are added as they are.
std::string imageTag(const Picture& picture, std::string_view alternative, std::string_view attributes = {});

/// "1 234 567"
std::string grouped(uint64_t number);
/// Milliseconds with about three digits: "0.042 ms", "12.3 ms", "1.20 s".
std::string duration(double milliseconds);
/// "x 1.23" against a reference time; empty when there is none.
std::string ratio(double time, double reference);
/// A number with enough digits to tell neighbouring codes apart.
std::string precise(double value);

/// A whole page with the report's style; `title` is plain text, `body` HTML.
std::string page(std::string_view title, std::string_view body);

/// A bar with one section per class that occurs, and the counts in words below it. `ours`: the comparison's
/// first driver is one of ours; otherwise nothing in it is marked as failed.
std::string classBar(const std::array<uint64_t, kPixelClassCount>& counts, bool ours);
/// What the colours of bars, class maps and heat maps mean.
std::string legend();
/// The title of a driver, or "oracle".
std::string titleOf(const Report& report, std::string_view driver);
bool isOurs(const Report& report, std::string_view driver);
std::string verdictPill(const ReportScene& scene);

/// The pages (report.h's writeReport() stores them).
std::string indexPage(const Report& report);
std::string scenePage(const Report& report, const ReportScene& scene);
/// Who is right in a scene, and why drivers differ; empty without an oracle.
std::string verdictSection(const Report& report, const ReportScene& scene);
/// The same of one driver in a sentence.
std::string verdictText(const ReportDriver& driver, const ReportVerdict& verdict);
std::string reportJson(const Report& report);

/// The style sheet; light and dark follow the reader's setting.
extern const char* const kReportStyle;
/// Switches the pictures of a viewer in place.
extern const char* const kReportScript;

}  // namespace vernier::conformance
