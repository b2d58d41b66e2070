/** What the server reads of files that somebody brings: the lines of a DXF drawing, the cells of a ROS map. */
import { useQuery } from "@tanstack/react-query";
import { api } from "./client";
import type { components } from "./schema";

export type BroughtDrawing = components["schemas"]["DrawingShape"];
type BroughtMapShape = components["schemas"]["BroughtMapShape"];
export type BroughtMap = Omit<BroughtMapShape, "cells"> & { cells: Uint8Array };

const keyOf = (file: File | null) => (file ? [file.name, file.size, file.lastModified] : null);
/** A file is read once; what is refused once is refused again. */
const ONCE = { retry: false, staleTime: Infinity, gcTime: 0, refetchOnWindowFocus: false } as const;

/** The lines of a drawing by layer. */
export const useBroughtDrawing = (slug: string, file: File | null) =>
  useQuery({
    queryKey: ["brought-drawing", slug, keyOf(file)],
    queryFn: () => {
      const form = new FormData();
      if (file) form.set("drawing", file);
      return api.upload<BroughtDrawing>(`/sites/${slug}/map/drawing`, form);
    },
    enabled: file !== null,
    ...ONCE,
  });

async function unpack(packed: string): Promise<Uint8Array> {
  const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
  const cells = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(cells).arrayBuffer());
}

/** The cells of a ROS map; asked for while `form` is given. */
export const useBroughtMap = (slug: string, files: readonly (File | null)[], form: (() => FormData) | null) =>
  useQuery({
    queryKey: ["brought-map", slug, files.map(keyOf)],
    queryFn: async (): Promise<BroughtMap> => {
      const { cells, ...map } = await api.upload<BroughtMapShape>(
        `/sites/${slug}/map/read`,
        form?.() ?? new FormData(),
      );
      return { ...map, cells: await unpack(cells) };
    },
    enabled: form !== null,
    ...ONCE,
  });
