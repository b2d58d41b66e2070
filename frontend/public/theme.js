// Before the first paint: the theme that was chosen in this browser, else the system's.
(function () {
  var kept = null;
  try {
    kept = localStorage.getItem("vipo.theme");
  } catch {
    kept = null;
  }
  var dark = kept === "dark" || (kept !== "light" && matchMedia("(prefers-color-scheme: dark)").matches);
  var root = document.documentElement;
  root.setAttribute("data-theme", dark ? "dark" : "light");
  root.setAttribute("data-mantine-color-scheme", dark ? "dark" : "light");
})();
