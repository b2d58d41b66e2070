/** Whether a program starts by itself; shown only where it has a step that says when. */
import { Switch } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";
import { useOnce } from "@/api/once";
import { keys, useArmed } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { ArmedProgram, Role } from "@/api/types";

interface ArmSwitchProps {
  site: string;
  program: { id: string; kinds: readonly string[] };
  role: Role | undefined;
  /** Waits until what is seen of the program is stored, where it is seen. */
  stored?: () => Promise<void>;
}

export function ArmSwitch({ site, program, role, stored }: ArmSwitchProps) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const armed = useArmed(site).data?.find((each) => each.program === program.id);
  const begin = useOnce();
  const arm = useMutation({
    mutationFn: async (on: boolean) => {
      if (on) await stored?.();
      return begin<ArmedProgram[]>(`/programs/${program.id}/arm`, { on });
    },
    onSuccess: (all) => queries.setQueryData(keys.armed(site), all),
    onError: (error) =>
      notifications.show({ color: "red", message: error instanceof ApiProblem ? error.detail : error.message }),
  });
  if (!armed && !program.kinds.includes("on_event")) return null;
  return (
    <Switch
      size="xs"
      label={t("run.arm.short")}
      aria-label={t("run.arm.label")}
      title={armed ? t("run.arm.since", { name: armed.by, version: armed.version }) : t("run.arm.label")}
      checked={armed !== undefined}
      disabled={arm.isPending || !mayOperate(role)}
      onChange={(event) => arm.mutate(event.currentTarget.checked)}
    />
  );
}
