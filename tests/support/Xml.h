#pragma once
/// \file Xml.h
/// \brief A strict reader of small XML documents, to examine written pages.

#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace testing_xml {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;  ///< unescaped
  std::string text;                               ///< its own, unescaped
  std::vector<Element> children;

  const std::string& at(const std::string& attribute) const {
    static const std::string none;
    const auto found = attributes.find(attribute);
    return found == attributes.end() ? none : found->second;
  }
  bool hasClass(const std::string& one) const {
    return (' ' + at("class") + ' ').find(' ' + one + ' ') != std::string::npos;
  }
  /// Text of this element and of all elements below, in no particular order.
  std::string allText() const {
    std::string all = text;
    for (const Element& child : children) all += child.allText();
    return all;
  }
  /// Calls the function for this element and all below, parents first.
  void each(const std::function<void(const Element&)>& call) const {
    call(*this);
    for (const Element& child : children) child.each(call);
  }
  std::vector<const Element*> all(const std::function<bool(const Element&)>& wanted) const {
    std::vector<const Element*> found;
    each([&](const Element& one) {
      if (wanted(one)) found.push_back(&one);
    });
    return found;
  }
  std::vector<const Element*> named(const std::string& wanted) const {
    return all([&](const Element& one) { return one.name == wanted; });
  }
};

/// Throws std::runtime_error on XML that is not well-formed.
class Reader {
 public:
  explicit Reader(const std::string& text) : m_text(text) {}
  Element document() {
    expect("<!doctype html>\n");
    Element root = element();
    while (m_at < m_text.size())
      if (next() != '\n') fail("something follows the end");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(why + " at: " + m_text.substr(m_at > 40 ? m_at - 40 : 0, 90));
  }
  char peek() const {
    if (m_at >= m_text.size()) throw std::runtime_error("the document is cut short");
    return m_text[m_at];
  }
  char next() {
    const char c = peek();
    ++m_at;
    return c;
  }
  bool starts(const std::string& what) const {
    return m_text.compare(m_at, what.size(), what) == 0;
  }
  void expect(const std::string& what) {
    if (!starts(what)) fail("no " + what);
    m_at += what.size();
  }
  std::string name() {
    std::string result;
    while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '-') result += next();
    if (result.empty()) fail("a name is missing");
    return result;
  }
  std::string entity() {
    static const std::map<std::string, std::string> known{
        {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}};
    for (const auto& [code, letter] : known)
      if (starts(code)) {
        m_at += code.size();
        return letter;
      }
    fail("an & that is no entity");
  }
  std::string quoted() {
    expect("\"");
    std::string value;
    while (peek() != '"') {
      if (peek() == '<') fail("a < in an attribute");
      value += peek() == '&' ? entity() : std::string(1, next());
    }
    ++m_at;
    return value;
  }
  Element element() {
    Element one;
    expect("<");
    one.name = name();
    while (peek() == ' ') {
      ++m_at;
      const std::string key = name();
      expect("=");
      if (!one.attributes.emplace(key, quoted()).second) fail("attribute twice: " + key);
    }
    if (starts("/>")) {
      m_at += 2;
      return one;
    }
    expect(">");
    while (!starts("</")) {
      if (peek() == '<')
        one.children.push_back(element());
      else
        one.text += peek() == '&' ? entity() : std::string(1, next());
    }
    expect("</" + one.name + ">");
    return one;
  }

  const std::string& m_text;
  std::size_t m_at = 0;
};

inline Element parsePage(const std::string& page) {
  return Reader(page).document();
}

}  // namespace testing_xml
