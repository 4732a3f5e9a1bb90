#include "server/net/http/locked_page.hpp"

namespace overfly::net {
namespace {

// Colours and fonts are those of web/src/styles/base.css. The form's GET keeps the page's path and
// fragment, so that a link to a run still leads there.
constexpr const char* kBefore = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark">
<title>Overfly asks for its token</title>
<link rel="icon" href="data:,">
<style>
body { margin: 0; min-height: 100vh; display: grid; place-items: center; background: #0b0f15;
  color: #d7dde6; font: 14px/1.5 system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif; }
main { box-sizing: border-box; width: min(460px, 100vw - 32px); padding: 24px 28px;
  background: #121821; border: 1px solid #232d3a; border-radius: 5px; }
h1 { margin: 0 0 4px; font-size: 18px; }
p { margin: 0 0 14px; }
form { display: flex; gap: 8px; margin: 0 0 16px; }
input { flex: 1; min-width: 0; height: 32px; box-sizing: border-box; padding: 0 10px; font: inherit;
  color: inherit; background: #0b0f15; border: 1px solid #334052; border-radius: 4px; }
button { height: 32px; padding: 0 16px; font: inherit; font-weight: 600; color: #fff; cursor: pointer;
  background: #2563d6; border: 0; border-radius: 4px; }
button:hover { background: #3173ec; }
:focus-visible { outline: 2px solid #4d8dff; outline-offset: 1px; }
code { padding: 1px 4px; font-size: 12px; color: #cfe0ff; background: #1a222d; border-radius: 3px; }
a { color: #86b4ff; }
.hint { color: #8a94a6; font-size: 13px; }
.hint:last-child { margin: 0; }
.wrong { padding: 6px 10px; color: #ff8a82; background: #3c1a1b; border-radius: 4px; }
</style>
</head>
<body>
<main>
<h1>Overfly</h1>
<p>This server requires its token.</p>
)html";

constexpr const char* kWrong =
    "<p class=\"wrong\" role=\"alert\">This token is wrong. "
    "A server without a token file makes a new one at every start.</p>\n";

constexpr const char* kAfter = R"html(<form method="get">
<input name="token" type="password" aria-label="Token" placeholder="Token or whole address"
 autocomplete="off" spellcheck="false" required autofocus>
<button>Open</button>
</form>
<p class="hint">When the server started it printed its address with the token, a line such as
<code>http://127.0.0.1:8480/?token=...</code> &mdash; open that address, or paste it here. In a container it
is in the log: <code>docker compose logs</code>.</p>
<p class="hint">Did a link of another site lead here, in a browser that has access already?
<a href="">Continue</a></p>
</main>
</body>
</html>
)html";

}  // namespace

std::string locked_page(bool wrong) {
  return std::string(kBefore) + (wrong ? kWrong : "") + kAfter;
}

}  // namespace overfly::net
