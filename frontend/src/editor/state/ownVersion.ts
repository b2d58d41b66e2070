/** What is on this screen, kept outside of a program that does not take it: as a program of its own, or as a file. */
import { api } from "@/api/client";
import type { Program } from "@/api/types";
import type { ProgramDocument } from "@/program/document/document";

/** Make an empty program for a copy. */
export function makeProgram(site: string, name: string): Promise<Program> {
  return api.post<Program>(`/sites/${encodeURIComponent(site)}/programs`, { name });
}

/** Make a document the whole content of a program that was just made. */
export async function fillProgram(program: string, document: ProgramDocument): Promise<void> {
  await api.replace(`/programs/${program}/document`, document);
}

/** Give a document to the browser's downloads, as the interface takes it with PUT. */
export function download(name: string, document: ProgramDocument): void {
  const address = URL.createObjectURL(new Blob([JSON.stringify(document, null, 2)], { type: "application/json" }));
  const link = Object.assign(window.document.createElement("a"), { href: address, download: `${fileName(name)}.json` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

/** What every file system takes. */
export function fileName(name: string): string {
  const plain = name.replace(/[^\p{L}\p{N} ._-]/gu, "-").replace(/^[. ]+|[. ]+$/g, "");
  return plain || "program";
}
