import styles from "./parts.module.css";

const COLOURS = ["#4F46E5", "#C81E5F", "#0B7C96", "#8A5A00", "#00694A", "#8A3D92"] as const;

/** The colour that stands for somebody, always the same for one name. */
export function personColour(name: string): string {
  let sum = 0;
  for (const letter of name) sum = (sum * 31 + (letter.codePointAt(0) ?? 0)) % 9973;
  return COLOURS[sum % COLOURS.length] ?? COLOURS[0];
}

/** Up to two letters that stand for a name. */
export function initialsOf(name: string): string {
  const words = name.split(/\s+/).filter(Boolean);
  const chosen = words.length > 1 ? [words[0], words.at(-1)] : words;
  return chosen.map((word) => word?.[0]?.toUpperCase() ?? "").join("");
}

interface AvatarProps {
  name: string;
  initials?: string;
  colour?: string;
  size?: number;
  live?: boolean;
  /** Read aloud and shown on hover; left out where the name stands beside it. */
  title?: string;
}

export function Avatar({ name, initials, colour, size = 28, live, title }: AvatarProps) {
  const style = { width: size, height: size, fontSize: size * 0.37, background: colour ?? personColour(name) };
  return (
    <span
      className={styles.avatar}
      style={style}
      data-live={live || undefined}
      title={title}
      role={title ? "img" : undefined}
      aria-label={title}
      aria-hidden={title ? undefined : true}
    >
      {initials || initialsOf(name)}
    </span>
  );
}
