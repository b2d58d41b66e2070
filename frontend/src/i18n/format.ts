/** Numbers, spans and times in the language of the screen; units after a thin space. */
import i18next from "i18next";

const THIN = "\u202f";
const STEPS: readonly [Intl.RelativeTimeFormatUnit, number][] = [
  ["second", 60],
  ["minute", 60],
  ["hour", 24],
  ["day", 7],
  ["week", 4.3],
  ["month", 12],
  ["year", Infinity],
];

/** What is smaller is written as `3.2E-7`. */
const SMALLEST_PLAIN = 1e-5;

/** By language and digits: making one takes longer than a frame's whole painting of a robot. */
const numberFormats = new Map<string, Intl.NumberFormat>();

export function formatNumber(value: number, digits = 0): string {
  const key = `${i18next.language} ${digits}`;
  let format = numberFormats.get(key);
  if (!format) {
    format = new Intl.NumberFormat(i18next.language, { minimumFractionDigits: digits, maximumFractionDigits: digits });
    numberFormats.set(key, format);
  }
  return format.format(value);
}

/** A device's reading, which may be of any size: four figures below 1,000, then a tenth at most; never `-0`. */
export function formatReading(value: number): string {
  const size = Math.abs(value);
  const digits: Intl.NumberFormatOptions = size < 1000 ? { maximumSignificantDigits: 4 } : { maximumFractionDigits: 1 };
  const notation = size > 0 && size < SMALLEST_PLAIN ? "scientific" : "standard";
  return new Intl.NumberFormat(i18next.language, { ...digits, notation, signDisplay: "negative" }).format(value);
}

/** A size in bytes, in the largest unit of 1,000 that fits. */
export function formatBytes(bytes: number): string {
  const units = ["B", "kB", "MB", "GB", "TB"];
  const step = Math.min(units.length - 1, bytes < 1 ? 0 : Math.floor(Math.log10(bytes) / 3));
  return withUnit(formatNumber(bytes / 1000 ** step, step === 0 ? 0 : 1), units[step] ?? "B");
}

/** `2.20, -1.95`; with a stroke between them where the comma is the decimal sign. */
export function formatPoint(x: number, y: number): string {
  const [first, second] = [formatNumber(x, 2), formatNumber(y, 2)];
  return `${first}${first.includes(",") ? " / " : ", "}${second}`;
}

/** `62 °C`. */
export function withUnit(value: string, unit: string): string {
  return unit ? `${value}${THIN}${unit}` : value;
}

/** `1 min 6 s` out of seconds. */
export function formatSpan(seconds: number): string {
  const whole = Math.max(0, Math.round(seconds));
  const [hours, minutes, rest] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60), whole % 60];
  if (hours > 0) return `${withUnit(String(hours), "h")} ${withUnit(String(minutes), "min")}`;
  if (minutes > 0) return `${withUnit(String(minutes), "min")} ${withUnit(String(rest), "s")}`;
  return withUnit(String(rest), "s");
}

/** `12:18` out of seconds, `1:02:18` from an hour on. */
export function formatClock(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const [hours, minutes, rest] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60), whole % 60];
  const two = (part: number) => String(part).padStart(2, "0");
  return hours > 0 ? `${hours}:${two(minutes)}:${two(rest)}` : `${minutes}:${two(rest)}`;
}

/** `2 hours ago`; `now` in milliseconds since 1970. What just happened is never ahead, even where `now` is a bit old. */
export function formatAgo(iso: string, now: number): string {
  let amount = Math.min(0, new Date(iso).getTime() - now) / 1000;
  const words = new Intl.RelativeTimeFormat(i18next.language, { numeric: "auto" });
  for (const [unit, size] of STEPS) {
    if (Math.abs(amount) < size) return words.format(Math.round(amount), unit);
    amount /= size;
  }
  return words.format(Math.round(amount), "year");
}

/** Seconds since a moment, `0.4 s` below a minute, else `2 min`; for "last seen". */
export function formatAge(iso: string, now: number): string {
  const seconds = Math.max(0, (now - new Date(iso).getTime()) / 1000);
  if (seconds < 10) return withUnit(formatNumber(seconds, 1), "s");
  return formatSpan(seconds < 60 ? seconds : Math.round(seconds / 60) * 60).replace(new RegExp(` 0${THIN}s$`), "");
}

/** The browser's region where it speaks the screen's language, else that language. */
function region(): string {
  const language = i18next.language;
  return navigator.languages.find((name) => name.startsWith(`${language}-`)) ?? language;
}

/** Date and time of day as in the browser's region where it speaks the screen's language; for logs and details. */
export function formatMoment(iso: string): string {
  return new Intl.DateTimeFormat(region(), { dateStyle: "medium", timeStyle: "short" }).format(new Date(iso));
}

/** The time of day alone, where the day stands above it. */
export function formatTime(iso: string): string {
  return new Intl.DateTimeFormat(region(), { timeStyle: "short" }).format(new Date(iso));
}

/** `06:10` out of minutes since midnight, as the times of day of `formatTime` are written. */
export function formatTimeOfDay(minutes: number): string {
  const format = new Intl.DateTimeFormat(region(), { timeStyle: "short", timeZone: "UTC" });
  return format.format(new Date(minutes * 60_000));
}

/** The day alone, written out. */
export function formatDay(iso: string): string {
  return new Intl.DateTimeFormat(region(), { dateStyle: "long" }).format(new Date(iso));
}
