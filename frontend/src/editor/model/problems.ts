/** What the checks say, in the language of the screen. */
import type { Diagnostic, Words } from "./types";

export function inLanguage(diagnostics: readonly Diagnostic[], language: string): readonly Diagnostic[] {
  return diagnostics.map((each) => ({
    ...each,
    message: wordsIn(each.messages, language, each.message),
    fix: each.fix ? { ...each.fix, label: wordsIn(each.fix.labels, language, each.fix.label) } : null,
  }));
}

function wordsIn(words: Words | undefined, language: string, english: string): string {
  return language.startsWith("de") ? (words?.de ?? english) : english;
}
