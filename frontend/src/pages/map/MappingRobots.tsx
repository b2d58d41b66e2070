/** Ways to the robots that can map a floor by themselves: their pages tell them to, and show the map as it grows. */
import { Button } from "@mantine/core";
import { Radar } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices } from "@/api/queries";

const EXPLORE = "explore";

export function MappingRobots({ slug, small = false }: { slug: string; small?: boolean }) {
  const { t } = useTranslation();
  const devices = useDevices(slug).data ?? [];
  const able = devices.filter(
    (each) =>
      each.kind === "robot" && each.lifecycle === "approved" && each.methods.some((method) => method.name === EXPLORE),
  );
  return able.map((robot) => (
    <Button
      key={robot.id}
      component={Link}
      to={`/sites/${slug}/devices/${encodeURIComponent(robot.id)}#robot-map`}
      variant="default"
      size={small ? "xs" : "sm"}
      leftSection={<Radar size={small ? 14 : 16} aria-hidden="true" />}
    >
      {t("robotMap.letMap", { name: robot.name })}
    </Button>
  ));
}
