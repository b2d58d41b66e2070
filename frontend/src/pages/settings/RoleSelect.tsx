/** A role as a tinted field: chosen where that may be, else only told. */
import { NativeSelect } from "@mantine/core";
import { useTranslation } from "react-i18next";
import type { Role } from "@/api/types";
import { Chip, type Tone } from "@/design/Chip";
import styles from "./settings.module.css";

export const ROLES: readonly Role[] = ["viewer", "commenter", "operator", "author", "admin"];
const TONES: Record<Role, Tone> = {
  viewer: "quiet",
  commenter: "quiet",
  operator: "busy",
  author: "machine",
  admin: "brand",
};

export function RoleChip({ role }: { role: Role }) {
  const { t } = useTranslation();
  return <Chip tone={TONES[role]}>{t(`role.${role}`)}</Chip>;
}

interface Props {
  label: string;
  role: Role;
  /** A role is being set: none is chosen meanwhile, and the field keeps the focus. */
  busy: boolean;
  onChoose: (role: Role) => void;
}

export function RoleSelect({ label, role, busy, onChoose }: Props) {
  const { t } = useTranslation();
  return (
    <NativeSelect
      size="xs"
      className={styles.role}
      data-tone={TONES[role]}
      aria-label={label}
      aria-disabled={busy}
      value={role}
      data={ROLES.map((value) => ({ value, label: t(`role.${value}`) }))}
      onChange={(event) => (busy ? undefined : onChoose(event.currentTarget.value as Role))}
    />
  );
}
