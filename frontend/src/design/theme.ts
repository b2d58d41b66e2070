/** Mantine dressed in our tokens: its variables point at the CSS variables of tokens.css, so both themes follow. */
import { createTheme, type CSSVariablesResolver, type MantineColorsTuple } from "@mantine/core";

const brand: MantineColorsTuple = [
  "#EEEDFE",
  "#E0DEFC",
  "#B9B4F8",
  "#9993FF",
  "#8F89FF",
  "#6159EE",
  "#4F46E5",
  "#4F46E5",
  "#4038C7",
  "#332CA6",
];

/** The greys of the dark theme, as in tokens.css: from text to void. */
const dark: MantineColorsTuple = [
  "#EEF0F5",
  "#BCC3D1",
  "#949DB0",
  "#6C778D",
  "#3F495D",
  "#353E50",
  "#2B3241",
  "#191D27",
  "#10141C",
  "#0A0C11",
];

export const FONT = `"Inter Variable", Inter, system-ui, sans-serif`;
export const MONO = `"JetBrains Mono", ui-monospace, monospace`;

/** The theme; the words, in the language of the screen, name buttons that are only a cross or an eye. */
export const makeTheme = ({ close, showPassword }: { close: string; showPassword: string }) =>
  createTheme({
    fontFamily: FONT,
    fontFamilyMonospace: MONO,
    colors: { brand, dark },
    primaryColor: "brand",
    primaryShade: 6,
    defaultRadius: "md",
    radius: { xs: "4px", sm: "6px", md: "8px", lg: "12px", xl: "14px" },
    spacing: { xs: "6px", sm: "10px", md: "14px", lg: "20px", xl: "24px" },
    fontSizes: { xs: "12px", sm: "13px", md: "13px", lg: "14px", xl: "16px" },
    lineHeights: { xs: "1.4", sm: "1.45", md: "1.45", lg: "1.5", xl: "1.5" },
    headings: { fontFamily: FONT, fontWeight: "600" },
    shadows: { xs: "var(--sh-1)", sm: "var(--sh-1)", md: "var(--sh-2)", lg: "var(--sh-3)", xl: "var(--sh-3)" },
    respectReducedMotion: true,
    components: {
      // Named only: each is loaded with the screens and forms that have it.
      Button: { defaultProps: { size: "sm" } },
      TextInput: { defaultProps: { size: "sm" } },
      PasswordInput: {
        defaultProps: { visibilityToggleButtonProps: { "aria-label": showPassword, title: showPassword, tabIndex: 0 } },
      },
      Select: { defaultProps: { size: "sm", checkIconPosition: "right" } },
      Menu: { defaultProps: { shadow: "lg", radius: "lg", withinPortal: true, withInitialFocusPlaceholder: false } },
      Modal: {
        // A tap beside a dialog does not throw away what was typed into it.
        defaultProps: {
          radius: "lg",
          centered: true,
          shadow: "lg",
          closeOnClickOutside: false,
          closeButtonProps: { "aria-label": close },
        },
      },
      Notification: { defaultProps: { radius: "lg", closeButtonProps: { "aria-label": close } } },
      Tooltip: { defaultProps: { openDelay: 400, withinPortal: true } },
    },
  });

const variables = {
  "--mantine-color-body": "var(--panel)",
  "--mantine-color-text": "var(--text)",
  "--mantine-color-dimmed": "var(--text-3)",
  "--mantine-color-placeholder": "var(--text-3)",
  "--mantine-color-anchor": "var(--brand-ink)",
  "--mantine-color-error": "var(--error)",
  "--mantine-color-default": "var(--panel)",
  "--mantine-color-default-hover": "var(--panel-2)",
  "--mantine-color-default-color": "var(--text)",
  "--mantine-color-default-border": "var(--line-2)",
  "--mantine-color-disabled": "var(--panel-3)",
  "--mantine-color-disabled-color": "var(--text-3)",
  "--mantine-color-disabled-border": "var(--line)",
  "--mantine-color-brand-filled": "var(--btn-brand)",
  "--mantine-color-brand-filled-hover": "color-mix(in srgb, var(--btn-brand) 88%, black)",
  "--mantine-color-brand-light": "var(--brand-soft)",
  "--mantine-color-brand-light-hover": "color-mix(in srgb, var(--brand-soft) 80%, var(--brand-line))",
  "--mantine-color-brand-light-color": "var(--brand-ink)",
  "--mantine-color-brand-outline": "var(--brand)",
  "--mantine-color-brand-text": "var(--brand-ink)",
  "--mantine-primary-color-filled": "var(--btn-brand)",
};

export const variablesResolver: CSSVariablesResolver = () => ({ variables: {}, light: variables, dark: variables });
