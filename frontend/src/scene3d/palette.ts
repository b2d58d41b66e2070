/** The scene's colours, read from the design tokens of the theme that is on. */
export interface Palette {
  floor: string;
  void: string;
  wall: string;
  wallTop: string;
  grid: string;
  body: string;
  bodyDark: string;
  text: string;
  motion: string;
  busy: string;
  done: string;
  warn: string;
  warnFill: string;
  error: string;
  machine: string;
  dark: boolean;
}

export function readPalette(): Palette {
  const style = getComputedStyle(document.documentElement);
  const token = (name: string) => style.getPropertyValue(`--${name}`).trim() || "#888888";
  const dark = document.documentElement.dataset.theme === "dark";
  return {
    floor: dark ? token("line-2") : token("floor"),
    void: token("void"),
    wall: dark ? token("wall-edge") : token("wall"),
    wallTop: dark ? token("text-2") : token("wall-soft"),
    grid: dark ? token("wall-soft") : token("line-2"),
    body: dark ? token("text-2") : token("panel-3"),
    bodyDark: token("wall-soft"),
    text: dark ? token("text-2") : token("text-3"),
    motion: token("motion"),
    busy: token("busy"),
    done: token("done"),
    warn: token("warn"),
    warnFill: token("warn-fill"),
    error: token("error"),
    machine: token("machine"),
    dark,
  };
}
