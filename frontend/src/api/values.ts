/** Values that many shapes have. */

export type Point = [number, number];

export type Scalar = string | number | boolean;

/** Why something waits; devices are named by their ids. */
export interface WaitReason {
  code: string;
  args: Record<string, Scalar>;
}

/** A sentence in each language of the screens. */
export interface Words {
  en: string;
  de: string;
}
