#include "rom/curve/measured_curve.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::rom {
namespace {

constexpr std::string_view header = "head_mmHg,flow_l_per_min";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  const auto last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

bool read_number(std::string_view text, double& value) {
  std::string_view digits = trimmed(text);
  if (digits.size() > 1 && digits.front() == '"' && digits.back() == '"') {
    digits = trimmed(digits.substr(1, digits.size() - 2));
  }
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-' && digits[1] != '+') {
    digits.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return !digits.empty() && error == std::errc() && end == digits.data() + digits.size() &&
         std::isfinite(value);
}

/// The text in UTF-8, without a byte order mark. What UTF-16 has beyond ASCII becomes '?': it can stand in
/// comments alone.
std::string plain_text(const std::string& bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  if (bytes.size() >= 3 && byte(0) == 0xef && byte(1) == 0xbb && byte(2) == 0xbf) {
    return bytes.substr(3);
  }
  const bool little = bytes.size() >= 2 && byte(0) == 0xff && byte(1) == 0xfe;
  const bool big = bytes.size() >= 2 && byte(0) == 0xfe && byte(1) == 0xff;
  if (!little && !big) {
    return bytes;
  }
  std::string text;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const unsigned code = little ? byte(i) + 256U * byte(i + 1) : 256U * byte(i) + byte(i + 1);
    text += code < 0x80 ? static_cast<char>(code) : '?';
  }
  return text;
}

/// The columns of a header without quotes.
std::string without_quotes(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '"');
  return plain;
}

bool only_separators(std::string_view text) {
  return text.find_first_not_of(", \t\"") == std::string_view::npos;
}

/// Reads "# key = number" or "# key: number" into `value`; leaves other comments alone.
void read_setting(std::string_view comment, std::string_view key, std::optional<double>& value,
                  const std::string& where) {
  const auto equals = comment.find_first_of("=:");
  if (equals == std::string_view::npos || trimmed(comment.substr(1, equals - 1)) != key) {
    return;
  }
  double number = 0;
  if (!read_number(comment.substr(equals + 1), number) || !(number > 0) || value) {
    throw InputError("the measured data do not state how the pump was driven",
                     std::string(comment.substr(0, 80)),
                     "one line # " + std::string(key) + " = a positive number", where);
  }
  value = number;
}

/// Sorts both columns by head, then flow.
void sort_samples(MeasuredCurve& curve) {
  std::vector<std::pair<double, double>> samples;
  for (std::size_t i = 0; i < curve.head_mmHg.size(); ++i) {
    samples.emplace_back(curve.head_mmHg[i], curve.flow_l_per_min[i]);
  }
  std::sort(samples.begin(), samples.end());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::tie(curve.head_mmHg[i], curve.flow_l_per_min[i]) = samples[i];
  }
}

} // namespace

double QuadraticFit::operator()(double head_mmHg) const {
  return coefficients[0] + head_mmHg * (coefficients[1] + head_mmHg * coefficients[2]);
}

MeasuredCurve read_measured_curve(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream raw(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, ignored) || !raw) {
    throw InputError("the measured data cannot be read", "no readable file \"" + file.string() + '"',
                     "a CSV file with columns " + std::string(header), "the name of the file");
  }
  std::istringstream stream(
      plain_text({std::istreambuf_iterator<char>(raw), std::istreambuf_iterator<char>()}));
  MeasuredCurve curve;
  bool has_header = false;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;
    const std::string_view text = trimmed(line);
    const std::string where = file.string() + ":" + std::to_string(line_number);
    if (only_separators(text)) {
      continue;
    }
    if (text.front() == '#') {
      if (!has_header) {
        read_setting(text, "frequency_Hz", curve.frequency_Hz, where);
        read_setting(text, "stroke_mm", curve.stroke_mm, where);
        read_setting(text, "voltage_V", curve.voltage_V, where);
      }
      continue;
    }
    if (!has_header) {
      if (without_quotes(text) != header) {
        throw InputError("the columns of the measured data are not known", std::string(text.substr(0, 80)),
                         "a header line " + std::string(header), where);
      }
      has_header = true;
      continue;
    }
    const auto comma = text.find(',');
    double head = 0;
    double flow = 0;
    if (comma == std::string_view::npos || !read_number(text.substr(0, comma), head) ||
        !read_number(text.substr(comma + 1), flow)) {
      throw InputError("a line of the measured data is not a sample", std::string(text.substr(0, 80)),
                       "two finite numbers, head in mmHg and flow in l/min", where);
    }
    curve.head_mmHg.push_back(head);
    curve.flow_l_per_min.push_back(flow);
  }
  const std::size_t heads = std::set<double>(curve.head_mmHg.begin(), curve.head_mmHg.end()).size();
  if (heads < 3) {
    throw InputError("too few measured samples for a curve", std::to_string(heads) + " different heads",
                     "at least 3", file.string() + ":" + std::to_string(line_number));
  }
  sort_samples(curve);
  curve.fit = fit_quadratic(curve.head_mmHg, curve.flow_l_per_min);
  return curve;
}

QuadraticFit fit_quadratic(std::span<const double> head_mmHg, std::span<const double> flow_l_per_min) {
  const auto n = static_cast<Eigen::Index>(head_mmHg.size());
  const Eigen::Map<const Eigen::VectorXd> head(head_mmHg.data(), n);
  const Eigen::Map<const Eigen::VectorXd> flow(flow_l_per_min.data(), n);
  // Centred and scaled, the columns are far from dependent.
  const double centre = head.mean();
  const double scale = (head.array() - centre).abs().maxCoeff();
  const Eigen::ArrayXd x = (head.array() - centre) / scale;
  Eigen::MatrixXd columns(n, 3);
  columns << Eigen::VectorXd::Ones(n), x.matrix(), x.square().matrix();
  const Eigen::Vector3d scaled = columns.colPivHouseholderQr().solve(flow);

  QuadraticFit fit;
  fit.coefficients[2] = scaled[2] / (scale * scale);
  fit.coefficients[1] = scaled[1] / scale - 2 * centre * fit.coefficients[2];
  fit.coefficients[0] = scaled[0] - scaled[1] * centre / scale + centre * centre * fit.coefficients[2];
  fit.scatter_l_per_min =
      n > 3 ? std::sqrt((columns * scaled - flow).squaredNorm() / static_cast<double>(n - 3)) : 0.0;
  return fit;
}

std::vector<ExtractedPoint> extract_points(const MeasuredCurve& curve, std::span<const double> heads_mmHg) {
  std::vector<ExtractedPoint> points;
  for (const double head : heads_mmHg) {
    if (head < curve.head_mmHg.front() || head > curve.head_mmHg.back()) {
      throw InputError(
          "a head lies outside the measured curve", std::to_string(head) + " mmHg",
          std::to_string(curve.head_mmHg.front()) + " to " + std::to_string(curve.head_mmHg.back()) + " mmHg",
          "the heads asked for");
    }
    const auto nearest =
        std::min_element(curve.head_mmHg.begin(), curve.head_mmHg.end(),
                         [&](double a, double b) { return std::abs(a - head) < std::abs(b - head); });
    const auto index = static_cast<std::size_t>(nearest - curve.head_mmHg.begin());
    points.push_back({head, curve.fit(head), *nearest, curve.flow_l_per_min[index]});
  }
  return points;
}

} // namespace undula::rom
